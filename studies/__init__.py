# SPDX-License-Identifier: BSD-3-Clause
"""What makes the physical results of the project, a package for each study: `isostat study NAME`."""
