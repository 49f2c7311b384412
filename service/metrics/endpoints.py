"""``/metrics``."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response
from prometheus_client import CollectorRegistry, generate_latest
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4

router = APIRouter(include_in_schema=False)

PATH = "/metrics"


@router.get(PATH)
def metrics(request: Request) -> Response:
    """What Prometheus asks for."""
    registry: CollectorRegistry = request.app.state.metrics
    headers = {"Cache-Control": "no-store"}
    return Response(generate_latest(registry), headers=headers, media_type=CONTENT_TYPE_PLAIN_0_0_4)
