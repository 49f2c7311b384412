"""The site of the documentation: ``python -m scripts.docs_site`` builds it, ``make site``.

Pages are staged (``staging``), those of the Python interface are made of docstrings (``python_reference``), the
navigation is that of docs/README.md (``navigation``), and ``zensical`` makes HTML of them.
"""
