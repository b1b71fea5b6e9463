# SPDX-License-Identifier: BSD-3-Clause
"""Runs that are calls of Python functions, each in a process of its own.   tested: tests/apps/study_test.py

    python3 -m isostat.campaign.functions CALL.json RESULTS     what such a process does
"""
import contextlib
import importlib
import json
import pathlib
import sys
from collections.abc import Callable
from typing import Any

from isostat.campaign.folder import write_replacing
from isostat.campaign.runs import Run


class FunctionRun(Run):
    """function(results, **arguments) of a module; the dictionary that it returns is kept in RESULTS/result.json.

    Its program is the folder from which the module is imported.
    """

    @classmethod
    def of(cls, folder: pathlib.Path, name: str, function: Callable[..., dict[str, Any]],
           arguments: dict[str, Any]) -> "FunctionRun":
        module, folder = sys.modules[function.__module__], folder.absolute()
        depth = module.__name__.count(".") + hasattr(module, "__path__")
        text = json.dumps({"module": module.__name__, "function": function.__name__, "arguments": arguments}, indent=1)
        return cls(name, text, folder / "scenes" / f"{name}.json", folder / "runs" / name, folder / "logs" / f"{name}.log",
                   str(pathlib.Path(str(module.__file__)).absolute().parents[depth]))

    def command(self, resumed: bool) -> list[str]:
        paths = f"{pathlib.Path(__file__).absolute().parents[2]}:{self.program}"
        return ["env", f"PYTHONPATH={paths}", f"OMP_NUM_THREADS={self.threads}", sys.executable, "-B", "-m", __name__,
                str(self.scene), str(self.results)]

    @property
    def result(self) -> dict[str, Any]:
        return json.loads((self.results / "result.json").read_text(encoding="utf-8"))

    is_of_this_scene = False  # it begins again

    @property
    def is_finished(self) -> bool:
        with contextlib.suppress(OSError, ValueError, KeyError):
            return self.result["call"] == json.loads(self.text)
        return False


def main(call_file: str, results_folder: str) -> None:
    call, results = json.loads(pathlib.Path(call_file).read_text(encoding="utf-8")), pathlib.Path(results_folder)
    results.mkdir(parents=True, exist_ok=True)
    found = getattr(importlib.import_module(call["module"]), call["function"])(results, **call["arguments"])
    write_replacing(results / "result.json", json.dumps({"call": call, **found}, indent=1))


if __name__ == "__main__":
    main(*sys.argv[1:])
