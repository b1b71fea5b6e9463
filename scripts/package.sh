#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Debian packages of the programs, the libraries, the Python module and the documentation, in build/package/packages.
# `scripts/package.sh --check FOLDER` also installs them in a new system of this Debian below FOLDER (root, network, some minutes) and
# runs there: a drained test from Python with its figure, a program built with find_package, every --version and manual.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh --packages
cmake --preset package
cmake --build --preset package --parallel "$(nproc)"
cmake --build --preset package --parallel "$(nproc)" --target manual_pages
(cd build/package && cpack -G DEB >/dev/null)
ls -sh1 build/package/packages/*.deb

if [[ "${1:-}" == --check ]]; then
  exec packaging/check.sh "${2:?a folder for the new Debian}" build/package/packages
fi
