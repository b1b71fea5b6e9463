# SPDX-License-Identifier: BSD-3-Clause
"""The figures of Isostat's programs: one module per program, drawn by `python3 -m figures PROGRAM RESULTS`."""
