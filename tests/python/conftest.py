import os
import pathlib
import subprocess

import pytest


@pytest.fixture(scope="session")
def program():
    """The name of the program tyndall."""
    return os.environ["TYNDALL_PROGRAM"]


@pytest.fixture(scope="session")
def scenes():
    return pathlib.Path(os.environ["TYNDALL_SCENES"])


@pytest.fixture(scope="session")
def small():
    """Parameters of tables that are built in a moment."""
    return {"tables.size": "8,16,16,4", "tables.orders": 2}


@pytest.fixture(scope="session")
def run(program):
    def call(*arguments):
        return subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout

    return call
