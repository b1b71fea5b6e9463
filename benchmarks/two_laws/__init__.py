# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the campaign two_laws: what is run (plan), tables and figures (report)."""
