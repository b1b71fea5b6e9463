#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Another Debian, from nothing, in a folder; as root, with no service. mmdebstrap (a Debian package) makes a minimal system
# of the suite in build/debian/SUITE unless it is there; remove that folder to begin again.
#
#   scripts/other_debian.sh trixie               this commit, built and tested there by scripts/test.sh: 40 minutes
#   scripts/other_debian.sh trixie COMMAND...    a command there, in this folder, which is the same there, as is /tmp
set -euo pipefail
suite=${1:?a suite of Debian, such as trixie; see the head of this file}
shift
here=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD/build/debian/$suite

if [[ ! -e $root/bin/sh ]]; then
  if [[ "$(id -u)" != 0 ]]; then
    echo "other_debian: a new root needs the rights of root; call it with sudo" >&2
    exit 1
  fi
  command -v mmdebstrap >/dev/null || { apt-get update -q && apt-get install -q -y mmdebstrap; } >&2
  mkdir -p "$(dirname "$root")"
  mmdebstrap --quiet --variant=minbase --include=ca-certificates "$suite" "$root.new" \
    "${MIRROR:-http://deb.debian.org/debian}" >&2
  mv "$root.new" "$root"
fi

# inside FOLDER COMMAND...: with mounts that end with the command, `shared` among them, and little of the environment.
shared=(/dev /sys)
inside() {
  unshare --mount --pid --fork --kill-child bash -euc '
    root=$1 here=$2 shared=$3
    shift 3
    mount --make-rprivate /
    for folder in $shared; do
      mkdir -p "$root$folder"
      mount --rbind "$folder" "$root$folder"
    done
    mount -t proc proc "$root/proc"
    exec chroot "$root" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
      DEBIAN_FRONTEND=noninteractive ${CI:+CI="$CI"} ${OMP_NUM_THREADS:+OMP_NUM_THREADS="$OMP_NUM_THREADS"} \
      sh -c "cd \"\$0\" && exec \"\$@\"" "$here" "$@"' bash "$root" "$1" "${shared[*]}" "${@:2}"
}

if (($#)); then
  shared+=(/tmp "$PWD" "$here")
  inside "$here" "$@"
else
  rm -rf "$root/isostat"
  git clone -q . "$root/isostat"
  CI=true inside /isostat scripts/test.sh
fi
