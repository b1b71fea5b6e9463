#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# manual_page.sh HELP2MAN PROGRAM PAGE.gz: the manual page of a program, from its --help. MPI may be started as root.
set -eu
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
name=$("$2" --help | head -n 1)
"$1" --no-info --section 1 --name "$name" "$2" | gzip -9n >"$3"
