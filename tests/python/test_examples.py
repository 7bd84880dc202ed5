"""The examples run and make a figure."""
import os
import pathlib
import subprocess
import sys

import pytest

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"
FIGURES = sorted(path.stem for path in EXAMPLES.glob("*.py") if path.stem not in ("figure", "speed"))


@pytest.mark.parametrize("name", FIGURES)
def test_figure(name, tmp_path, small):
    picture = tmp_path / "figure.png"
    sets = [word for key, value in small.items() for word in ("--set", f"{key}={value}")]
    done = subprocess.run([sys.executable, "-B", EXAMPLES / f"{name}.py", "-o", picture, "--points", "12", *sets], text=True,
                          capture_output=True, env={**os.environ, "MPLCONFIGDIR": str(tmp_path)})
    assert done.returncode == 0, done.stderr
    assert picture.read_bytes()[:4] == b"\x89PNG" and picture.stat().st_size > 10000


def test_all_examples_are_tried():
    assert len(FIGURES) >= 5
