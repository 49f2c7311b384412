"""The request and response models of jobs."""

from __future__ import annotations

import json
from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from service.libraries.endpoints import GridDocument
from threadstate.device.document import DeviceDocument, device_document
from threadstate.errors import InvalidValueError
from threadstate.jobs.model import JobEvent, JobInputs, JobRecord
from threadstate.jobs.names import EventKind, JobKind, JobState
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import DEFAULT_SCENE, Descent, FinalStep, MeshOptions, Scene, Tangent
from threadstate.mesh.presets import Preset
from threadstate.settled.inputs import SettledInputs
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation

_FORBID = ConfigDict(extra="forbid")
_DEFAULTS = SolveOptions()

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]


class GridToCompute(BaseModel):
    """The grid, in degrees: roll and pitch +-``tilt_max``, phase 0 up to but without 360."""

    model_config = _FORBID

    tilt_max: Number = 4.0
    tilt_step: Number = 1.0
    phase_step: Number = 1.0


class Tolerances(BaseModel):
    """LimitsMiddleware and tolerances; lengths in multiples of the thread pitch."""

    model_config = _FORBID

    turn_limit_deg: Number = _DEFAULTS.turn_limit_deg
    quasi_stable_fraction: Number = _DEFAULTS.quasi_stable_fraction
    tie_tolerance: Number = _DEFAULTS.tie_tolerance
    embedment_tolerance: Number = _DEFAULTS.embedment_tolerance


class MeshSettings(BaseModel):
    """Settings of the solver method `mesh`, as on the command line."""

    model_config = _FORBID

    preset: Preset = Preset.PAPER
    descent: Descent = Descent.SAFE
    final_step: FinalStep = FinalStep.ONE_MICROINCH
    tangent: Tangent = Tangent.EDGE
    scene: Scene = DEFAULT_SCENE
    checked: Annotated[bool, Field(strict=True)] = True


class JobRequest(BaseModel):
    """A library to compute."""

    model_config = ConfigDict(
        **_FORBID,
        json_schema_extra={
            "examples": [{"designation": DEFAULT_DESIGNATION, "grid": {"phase_step": 5.0}}],
            "if": {"required": ["mesh"], "properties": {"mesh": {"type": "object"}}},
            "then": {"required": ["method"], "properties": {"method": {"const": SolverMethod.MESH.value}}},
        },
    )

    designation: Annotated[str, Field(min_length=1, max_length=100, description="the thread")] = DEFAULT_DESIGNATION
    grid: GridToCompute = GridToCompute()
    method: SolverMethod = SolverMethod.EXACT
    tolerances: Tolerances = Tolerances()
    mesh: MeshSettings | None = Field(default=None, description="of the solver method `mesh` alone")

    def inputs(self) -> LibraryInputs:
        """The inputs of the library.

        Raises:
            InvalidValueError: a value is out of range, or mesh settings are given for another solver method.
        """
        if self.mesh is not None and self.method is not SolverMethod.MESH:
            raise InvalidValueError("mesh", "given", "settings of the solver method `mesh` alone")
        return LibraryInputs(
            pair_by_designation(self.designation),
            Grid(self.grid.tilt_max, self.grid.tilt_step, self.grid.phase_step),
            SolveOptions(**dict(self.tolerances)),
            None if self.method is SolverMethod.EXACT else _mesh_options(self.mesh or MeshSettings()),
        )


RESULT_PATHS = {
    JobKind.LIBRARY: "/v1/libraries",
    JobKind.SETTLED: "/v1/settled",
    JobKind.SUCCESS: "/v1/success-maps",
}


class JobDocument(BaseModel):
    """A job."""

    id: int
    kind: JobKind = Field(description="what it computes")
    state: JobState
    reason: str | None = Field(description="why it failed")
    designation: str
    method: SolverMethod | None = Field(description="of a library of contact states")
    device: DeviceDocument | None = Field(description="of a library of settled states or a success map")
    grid: GridDocument
    options: dict[str, float | str | bool | list[float]] = Field(
        description="limits and tolerances of the solver; of a success map strategy, frictions, tolerances and limit"
    )
    input_sha256: str = Field(description="hash of all of these; equal hashes are the same job")
    code_version: str = Field(description="workers of another version do not take it")
    chunks: int = Field(description="number of orientations")
    committed: int = Field(description="number of computed orientations")
    at_work: int = Field(description="number of orientations that workers are computing")
    library: int | None = Field(description="number of the published library of contact states")
    result: str | None = Field(description="address of what is published")
    asked_at: datetime
    ended_at: datetime | None


class JobPage(BaseModel):
    """Jobs, the latest first."""

    jobs: list[JobDocument]
    next: str | None = Field(description="address of the next page; null on the last")


class EventDocument(BaseModel):
    """An event of a job: the ``data`` of an event of the stream."""

    job: int
    kind: EventKind
    at: datetime
    committed: int = Field(description="number of committed chunks at the time")
    chunks: int
    reason: str | None


def job_document(job: JobRecord) -> JobDocument:
    """The document of a job."""
    inputs, grid = job.inputs, job.inputs.grid
    is_library = isinstance(inputs, LibraryInputs)
    return JobDocument(
        id=job.id,
        kind=job.kind,
        state=job.state,
        reason=job.reason,
        designation=job.inputs.pair.designation,
        method=inputs.method if isinstance(inputs, LibraryInputs) else None,
        device=None if isinstance(inputs, LibraryInputs) else DeviceDocument(**device_document(inputs.device)),
        grid=GridDocument(
            tilt_max=grid.tilt_max_deg,
            tilt_step=grid.tilt_step_deg,
            phase_step=grid.phase_step_deg,
            orientations=grid.orientation_count,
        ),
        options=_options(inputs),
        input_sha256=job.input_sha256,
        code_version=job.code_version,
        chunks=job.chunk_count,
        committed=job.done_count,
        at_work=job.lease_count,
        library=job.published_id if is_library else None,
        result=None if job.published_id is None else f"{RESULT_PATHS[job.kind]}/{job.published_id}",
        asked_at=job.asked_at,
        ended_at=job.ended_at,
    )


def _options(inputs: JobInputs) -> dict[str, float | str | bool | list[float]]:
    if isinstance(inputs, LibraryInputs):
        options: dict[str, float | str | bool | list[float]] = json.loads(inputs.options_json)
        return options
    if isinstance(inputs, SettledInputs):
        return {}
    return {
        "strategy": inputs.strategy.value,
        "mu": list(inputs.frictions),
        "phase_tolerance": inputs.phase_tolerance_deg,
        "mu_tolerance": inputs.mu_tolerance,
        "point_limit": inputs.point_limit,
    }


def event_document(job: JobRecord, event: JobEvent) -> EventDocument:
    """The document of an event of a job."""
    return EventDocument(
        job=job.id,
        kind=event.kind,
        at=event.at,
        committed=event.done_count,
        chunks=job.chunk_count,
        reason=event.reason,
    )


def _mesh_options(chosen: MeshSettings) -> MeshOptions:
    return MeshOptions(
        tessellation=chosen.preset.tessellation,
        descent=chosen.descent,
        final_step=chosen.final_step.thread_pitches,
        tangent=chosen.tangent,
        scene=chosen.scene,
        checked=chosen.checked,
    )
