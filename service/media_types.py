"""Media types of what the service's pages are made of."""

HTML = "text/html; charset=utf-8"
JAVASCRIPT = "text/javascript; charset=utf-8"
CSS = "text/css; charset=utf-8"
SVG = "image/svg+xml"
TEXT = "text/plain; charset=utf-8"
