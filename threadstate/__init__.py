"""Contact states of a bolt that meets a nut askew, computed exactly.

The packages, in the order in which data flows: ``thread`` (solids), ``contact`` (where they touch), ``state`` (the
contact state of a pose), ``mesh`` (the same by the collision of triangle meshes), ``library`` (stored states of a
pair),
``history`` (phase circles cut where a label changes), ``network`` (transitions between formations of contacts),
``stored_histories`` (histories as rows of the tables, and back), ``responses`` (response models of histories and
networks), ``export`` (tables as files), ``jobs`` and ``access`` (requested libraries, API keys), ``client`` (the client
of a service).
"""

from threadstate._numba_cache import choose_numba_cache

__version__ = "0.1.0"

choose_numba_cache()  # before any module of the package imports numba
