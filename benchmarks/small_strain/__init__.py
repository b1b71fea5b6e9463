# SPDX-License-Identifier: BSD-3-Clause
"""The parts of benchmarks/small_strain.py: what is run, how, and what is drawn of it."""
