"""Contact states of a bolt that meets a nut askew, computed exactly.

The rooms, in the order in which data flows: ``thread`` (solids), ``contact`` (where they touch),
``state`` (what a pose comes to), ``mesh`` (the same by the collision of triangle meshes), ``library`` (all states of
a pair, stored), ``history`` (phase circles cut where a label changes), ``network`` (which formation of contacts leads
to which), ``archive`` (histories in the tables, and back), ``answer`` (what is told of histories and networks),
``export`` (all of it as files), ``client`` (asks a service for all of it).
"""

from threadstate._numba_cache import choose_numba_cache

__version__ = "0.1.0"

choose_numba_cache()  # before any module of the package imports numba
