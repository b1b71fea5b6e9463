# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the benchmark speed_error: what is run (plan), how (runner), what is measured (paths), what is said of it
(tables, figures)."""
