#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# check.sh ROOT PACKAGES: makes a system of this Debian in the folder ROOT if there is none, installs the packages with their
# dependencies, and uses them as one does who has no sources.
set -euo pipefail
root=$1 packages=$2
if [[ ! -e $root/bin/sh ]]; then
  suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
  mmdebstrap --quiet --variant=minbase "$suite" "$root" "${MIRROR:-http://deb.debian.org/debian}"
fi
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }
for name in apt/apt.conf.d/01proxy resolv.conf; do
  if [[ -e /etc/$name ]]; then cp -L "/etc/$name" "$root/etc/$name"; fi
done
mkdir -p "$root/packages"
cp "$packages"/*.deb "$(dirname "$0")/drained.py" "$root/packages"
inside sh -c 'apt-get update -q && apt-get install -q -y --no-install-recommends /packages/*.deb' >"$root/install.log" 2>&1 ||
  { tail -n 20 "$root/install.log"; exit 1; }

start=$SECONDS
inside sh -c 'cd /root && python3 /packages/drained.py'
echo "drained test run and drawn: $((SECONDS - start)) s"
for program in isostat element_test soil_column micromechanics void_ratio_limits; do
  inside "$program" --version
  [[ -s $root/usr/share/man/man1/$program.1.gz || -n "${NO_MANUALS:-}" ]]
done
inside sh -c 'cd /root && isostat library rve_library.toml -q -o library.h5 --set grading.grains=300 \
  --set grading.cloud_edge="3.107 mm" --set contact.young="1 GPa" && isostat resistance --help >/dev/null'
inside sh -c 'cd /root && cmake -S /usr/share/doc/isostat/examples -B examples -DCMAKE_BUILD_TYPE=Release >cmake.log &&
  cmake --build examples >>cmake.log && ls examples'
