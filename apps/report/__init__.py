# SPDX-License-Identifier: BSD-3-Clause
"""Reports of finished runs, each one HTML file that needs no other: `report.html` of a run, `compare.html` of two."""
