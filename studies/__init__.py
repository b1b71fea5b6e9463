# SPDX-License-Identifier: BSD-3-Clause
"""What makes the physical results of the project, a package for each study: `isostat study NAME`."""
import pathlib

_ABOVE = pathlib.Path(__file__).resolve().parents[1]
APPS = _ABOVE / "apps" if (_ABOVE / "apps").is_dir() else _ABOVE  # with scenes, laboratory; or installed
