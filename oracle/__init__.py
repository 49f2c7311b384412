"""An independent brute-force check of the exact solver, written from ``docs/method.md`` alone. Development only.

Modules find things by dense sampling and polishing: ``first_height`` (first contacts), ``chamfer`` (those of a
chamfered bolt), ``overlap`` and ``turn`` (components of the overlap, in one pose and along a turn), ``lift`` (how far a
bolt has to be raised), ``rest`` (where a held bolt comes to rest), ``near_places`` and ``follow`` (its path as it is
turned), ``outcomes`` (how that ends). ``coulomb`` solves for contact forces. The others say what holds of a
contact or a state once it is found: ``solids``, ``region_rule``, ``contact_rules``, ``state_turns``.
``statics`` bounds what contacts can carry, from points and normals.

Shared with the solver are the pair's dimensions and the dataclasses of a state, and no formula: an import contract in
``pyproject.toml`` keeps every kernel out. ``docs/oracle.md`` is the page.
"""
