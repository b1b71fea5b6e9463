# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the benchmark free_grains: what is run (plan), what is measured (tables), what is drawn (figures)."""
