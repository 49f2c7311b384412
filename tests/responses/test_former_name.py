"""Programs that import the response models by the package's former name go on, and are warned."""

from __future__ import annotations

import subprocess
import sys

from threadstate.responses import documents


def test_the_former_name_gives_the_same_models_and_warns() -> None:
    code = "from threadstate.answer.documents import FallsDocument; print(FallsDocument.__module__)"
    run = subprocess.run([sys.executable, "-W", "default", "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == documents.FallsDocument.__module__
    assert "DeprecationWarning: threadstate.answer is now threadstate.responses" in run.stderr
