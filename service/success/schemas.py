"""The request and response models of success maps."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from service.jobs.schemas import GridToCompute, Number
from service.libraries.endpoints import GridDocument
from service.solve import NOT_BOTH, RequestOfPair
from threadstate.device.document import DeviceDocument, device_document
from threadstate.device.strategy import Strategy
from threadstate.success.inputs import FRICTIONS, MU_TOLERANCE, PHASE_TOLERANCE_DEG, POINT_LIMIT
from threadstate.success.read import SuccessMap
from threadstate.success.summary_document import FrictionTotalsDocument, SummarisedOrientationDocument
from threadstate.thread.catalogue import source_of
from threadstate.thread.standards.document import SourceDocument
from threadstate.units import LengthUnit

LARGEST_FRICTIONS = 100


class MapGrid(GridToCompute):
    """Orientations, roll and pitch +-``tilt_max``, and starting phases, ``phase_step`` apart; in degrees."""

    phase_step: Number = 30.0


class SuccessRequest(RequestOfPair):
    """A success map to compute."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"device": {"unit": "mm", "push": 10}, "strategy": "cw", "mu": [0, 0.1]}],
            **NOT_BOTH,
        },
    )

    device: DeviceDocument | None = Field(
        default=None, description="the device; what it leaves out is as of the default one"
    )
    strategy: Strategy = Field(
        default=Strategy.CCW_THEN_CW,
        strict=False,
        description="`ccw_then_cw`: counter-clockwise until the snap, then clockwise; `cw`: clockwise at once",
    )
    grid: MapGrid = Field(default=MapGrid(), description="orientations and starting phases")
    mu: Annotated[list[Number], Field(min_length=1, max_length=LARGEST_FRICTIONS)] = Field(
        default=list(FRICTIONS), description="coefficients of friction, 0 to 1, ascending"
    )
    phase_tolerance: Number = Field(
        default=PHASE_TOLERANCE_DEG, description="how far boundaries along the phase are narrowed, in degrees"
    )
    mu_tolerance: Number = Field(default=MU_TOLERANCE, description="how far the critical friction is narrowed")
    point_limit: Annotated[int, Field(strict=True)] = Field(
        default=POINT_LIMIT, description="points of a turn beyond which a path is undecided"
    )


class SuccessMapDocument(BaseModel):
    """A published success map."""

    id: int
    designation: str = Field(examples=["1/4-20 UNC"])
    source: SourceDocument
    device: DeviceDocument = Field(description="the device, its lengths in its own unit; null what another key has")
    strategy: Strategy
    grid: GridDocument
    mu: list[float] = Field(description="the frictions of the map, ascending")
    phase_tolerance: float
    mu_tolerance: float
    point_limit: int
    stored_unit: LengthUnit = Field(description="unit in which the map was computed and is stored")
    code_version: str
    input_sha256: str = Field(description="SHA-256 of everything that the content depends on")
    content_sha256: str = Field(description="SHA-256 of the content")
    created_at: datetime
    published_at: datetime


class SuccessMapDetail(SuccessMapDocument):
    """A published success map with its totals at each friction."""

    summary: list[FrictionTotalsDocument]


class SuccessMapList(BaseModel):
    """All published success maps, the latest first."""

    success_maps: list[SuccessMapDocument]


class SuccessOrientationPage(BaseModel):
    """Orientations of a map, in the order of roll and pitch."""

    success_map: int = Field(description="number of the map")
    unit: LengthUnit = Field(description="unit of all lengths in this response; torques are in N times it")
    orientations: list[SummarisedOrientationDocument]
    next: str | None = Field(description="address of the next page, null on the last; also as `Link: rel=next`")


class GrowingMap(BaseModel):
    """What is computed so far of a success map that is a job, in the order of roll and pitch."""

    job: int
    chunks: int = Field(description="number of orientations that the map will have")
    unit: LengthUnit = Field(description="unit of all lengths in this response; torques are in N times it")
    summary: list[FrictionTotalsDocument] = Field(description="totals of the orientations that are there")
    orientations: list[SummarisedOrientationDocument]


def success_map_document(record: SuccessMap) -> SuccessMapDocument:
    """The document of a map."""
    inputs, grid = record.inputs, record.inputs.grid
    return SuccessMapDocument(
        id=record.id,
        designation=inputs.pair.designation,
        source=source_of(inputs.pair),
        device=DeviceDocument(**device_document(inputs.device)),
        strategy=inputs.strategy,
        grid=GridDocument(
            tilt_max=grid.tilt_max_deg,
            tilt_step=grid.tilt_step_deg,
            phase_step=grid.phase_step_deg,
            orientations=grid.orientation_count,
        ),
        mu=list(inputs.frictions),
        phase_tolerance=inputs.phase_tolerance_deg,
        mu_tolerance=inputs.mu_tolerance,
        point_limit=inputs.point_limit,
        stored_unit=inputs.pair.unit,
        code_version=record.code_version,
        input_sha256=record.input_sha256,
        content_sha256=record.content_sha256,
        created_at=record.created_at,
        published_at=record.published_at,
    )
