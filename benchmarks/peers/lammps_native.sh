#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# lammps_native.sh FOLDER: LAMMPS from the source package of the Debian that this runs in, with GRANULAR alone, as a careful
# user builds it: -O3 -march=native. Leaves FOLDER/lmp in some minutes; does nothing if it is there.
set -euo pipefail
mkdir -p "$1"
cd "$1"
[[ ! -x lmp ]] || exit 0
. /etc/os-release
export DEBIAN_FRONTEND=noninteractive
apt-get update -q
apt-get install -q -y --no-install-recommends dpkg-dev g++ cmake make libopenmpi-dev
keys=/usr/share/keyrings/debian-archive-keyring.gpg
echo "deb-src [signed-by=$keys] ${MIRROR:-http://deb.debian.org/debian} $VERSION_CODENAME main" >sources.list
mkdir -p lists/partial
source_only=(-o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null
  -o Dir::State::Lists="$PWD/lists" -o APT::Sandbox::User=root)
apt-get "${source_only[@]}" update -q
apt-get "${source_only[@]}" source -q lammps
cmake -S lammps-*/cmake -B build -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O3 -march=native -DNDEBUG" \
  -DPKG_GRANULAR=ON -DBUILD_MPI=ON -DBUILD_OMP=OFF
cmake --build build --parallel "$(nproc)"
mv build/lmp lmp
