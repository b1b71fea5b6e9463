# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the campaign paper: what is run (plan), numbers of one test (states), tables of ensembles, figures."""
