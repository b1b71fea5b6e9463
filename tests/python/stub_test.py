# SPDX-License-Identifier: BSD-3-Clause
"""The stubs name what the compiled part has, nothing more and nothing less; and all of it says what it is."""
import ast
import importlib
import unittest

from package import ROOT, isostat

STUBS = ROOT / "python/isostat"
OWN = {"__init__", "__bool__", "__len__"}  # special names that a stub may have


def is_own(name):
    return name in OWN or not name.startswith(("__", "_pybind11"))


def compiled_modules():
    try:
        return [isostat._core, importlib.import_module("isostat._column")]
    except ModuleNotFoundError:  # built without finite elements
        return [isostat._core]


class StubTest(unittest.TestCase):
    def test_names_are_those_of_the_module(self):
        for module in compiled_modules():
            tree = ast.parse((STUBS / f"{module.__name__.rpartition('.')[2]}.pyi").read_text(encoding="utf-8"))
            classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
            functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
            self.assertEqual({*classes, *functions}, {name for name in vars(module) if is_own(name)})
            for name, node in classes.items():
                with self.subTest(name):
                    in_stub = {item.name for item in node.body if isinstance(item, ast.FunctionDef)} - OWN
                    compiled = {member for member in vars(getattr(module, name)) if is_own(member)} - OWN
                    self.assertEqual(in_stub, compiled)

    def test_everything_public_is_documented(self):
        undocumented = [f"{name}.{member}" for name in isostat.__all__ for owner in [getattr(isostat, name)]
                        for member in (vars(owner) if isinstance(owner, type) else ())
                        if not member.startswith("_") and not (getattr(owner, member).__doc__ or "").strip()]
        undocumented += [name for name in isostat.__all__ if not (getattr(isostat, name).__doc__ or "").strip()]
        self.assertEqual(undocumented, [])
