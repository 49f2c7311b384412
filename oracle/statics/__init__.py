"""A witness for the statics of contacts, written from ``docs/forces.md`` (sections 1 to 3 and 6) alone.

It works on arrays: points (k, 3), unit normals (k, 3) that point into the bolt, a load. ``friction`` bounds the least
friction at which contacts balance a load or wedge, with round cones (Clarabel) and with pyramids (HiGHS); ``loads``
says how far a load is from being supported, what must be added to it, and how large the contact forces have to be.

No number stands on a solver's word. Solvers only propose contact forces (an upper bound) and twists (a lower bound);
``certificates`` computes in plain arithmetic what each of them proves.
"""
