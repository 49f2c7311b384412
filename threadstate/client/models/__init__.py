"""The service's responses as frozen models; one file per resource.

Angles are in degrees, lengths in the ``unit`` of the answer. Fields that a newer service adds are left out, so that an
older client still works; a test holds the models to the service's own description.
"""
