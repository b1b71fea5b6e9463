#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what Isostat needs on Debian 12 or 13. Run it as often as you like: nothing happens, and the network is not
# touched, when every package is installed.
#
#   scripts/setup.sh            what building, testing and drawing need
#   scripts/setup.sh --gates    and what scripts/check_all.sh needs
#   scripts/setup.sh --fuzz     and what scripts/fuzz.sh needs
#   scripts/setup.sh --coverage and what scripts/coverage.sh needs
#   scripts/setup.sh --packages and what scripts/package.sh needs
#   scripts/setup.sh --docs     and what scripts/docs.sh needs
set -euo pipefail

packages=(
  git g++ gfortran cmake make ninja-build pkg-config
  libeigen3-dev libhdf5-openmpi-dev libtomlplusplus-dev libcli11-dev libfmt-dev nlohmann-json3-dev libhwy-dev librandom123-dev
  libpugixml-dev libboost-dev libgtest-dev libgmock-dev libbenchmark-dev zlib1g-dev
  libdeal.ii-dev libpetsc-real-dev openmpi-bin
  python3 python3-matplotlib python3-numpy python3-h5py python3-scipy python3-nlopt python3-mpi4py python3-distributed
  python3-dev pybind11-dev python3-pip python3-setuptools python3-wheel
)
clang=19
if [[ "$(. /etc/os-release && echo "${VERSION_ID:-}")" == 12 ]]; then clang=14; fi
case "${1:-}" in
  --gates) packages+=(clang-format clang-tidy chromium python3-vtk9 xvfb xauth) ;;
  --fuzz) packages+=(clang "libclang-rt-$clang-dev") ;;
  --coverage) packages+=(gcovr) ;;
  --packages) packages+=(help2man dpkg-dev fakeroot file mmdebstrap) ;;
  --docs) packages+=(python3-sphinx python3-myst-parser furo doxygen libjs-mathjax) ;;
esac

is_installed() { [[ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]; }

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "setup: all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if [[ "$(id -u)" != 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: missing packages: ${missing[*]}" >&2
    echo "setup: you are not root and there is no sudo; ask an administrator to apt-get install them" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "setup: installing ${missing[*]}"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
