"""The errors of the domain: each names the bad value and the valid range.

Every error takes its arguments as they are, so that it can be sent to another process.
"""

from __future__ import annotations


class ThreadstateError(Exception):
    """Base class of all errors of threadstate."""


class InvalidValueError(ThreadstateError, ValueError):
    """A value outside its valid range.

    Attributes:
        name: what the value is, in the field's terms.
        value: the value as given.
        valid: the valid range, in words.
    """

    def __init__(self, name: str, value: object, valid: str) -> None:
        super().__init__(name, value, valid)
        self.name = name
        self.value = value
        self.valid = valid

    def __str__(self) -> str:
        return f"{self.name} is {self.value!r}; valid: {self.valid}"


class ImpossibleThreadError(InvalidValueError):
    """Dimensions that no thread can have (fillets that do not fit, a bolt larger than its nut, ...)."""


class UnknownNameError(InvalidValueError):
    """A designation, region, class or flag that does not exist; ``valid`` lists those that do."""


class NotFoundError(ThreadstateError, LookupError):
    """Something that was requested by name is not stored."""


class UndecidedPoseError(NotFoundError):
    """A library has no state for a pose of its grid, as its solver method could not decide it; the message says why."""


class SchemaError(ThreadstateError):
    """The database's schema is not the one this code expects; the message names the command to run."""


class UnreadableDatabaseError(SchemaError):
    """The database's schema is unknown, as the database cannot be read."""


SEARCH_ENDED = "the search ended before every box was excluded"
"""Why the exact method leaves a pose undecided."""


class UnresolvedPoseError(ThreadstateError):
    """A pose could not be decided within the limits of the search; the message names the pose in degrees."""

    def __init__(
        self,
        roll_deg: float,
        pitch_deg: float,
        phase_deg: float,
        reason: str = SEARCH_ENDED,
    ) -> None:
        super().__init__(roll_deg, pitch_deg, phase_deg, reason)
        self.pose_deg = (roll_deg, pitch_deg, phase_deg)
        self.reason = reason

    def __str__(self) -> str:
        roll_deg, pitch_deg, phase_deg = self.pose_deg
        pose = f"roll {roll_deg!r}, pitch {pitch_deg!r}, phase {phase_deg!r} deg"
        return f"no certain contact state for {pose}: {self.reason}"


class MeshUndecidedError(UnresolvedPoseError):
    """The mesh method cannot decide a pose; ``reason`` says why."""


class MissingExtraError(ThreadstateError):
    """Something needs a package that is not installed; the message names the extra that installs it."""

    def __init__(self, purpose: str, extra: str) -> None:
        super().__init__(purpose, extra)
        self.purpose = purpose
        self.extra = extra

    def __str__(self) -> str:
        install = f"pip install '.[{self.extra}]' in a checkout of threadstate"
        return f"{self.purpose} needs the extra `{self.extra}`: {install}"
