"""The former name of :mod:`threadstate.responses`, for programs that import its models; removed in the next version."""

from __future__ import annotations

import sys
import warnings

from threadstate.responses import documents

sys.modules[f"{__name__}.documents"] = documents
warnings.warn("threadstate.answer is now threadstate.responses", DeprecationWarning, stacklevel=2)
