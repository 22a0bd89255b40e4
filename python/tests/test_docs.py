"""Documentation: every example runs, everything public is annotated and has the sections of numpydoc."""

import doctest
import importlib.util
import inspect
import pathlib

import numpy as np
import pytest

import walpha
import walpha.tda

MODULES = sorted(path.stem for path in pathlib.Path(walpha.__file__).parent.glob("*.py"))
# It cannot be imported where PyTorch is not there.
HAS_TORCH = importlib.util.find_spec("torch") is not None


def public():
    """Functions, classes and methods by name."""
    with_torch = [importlib.import_module("walpha.torch")] if HAS_TORCH else []
    for module in (walpha, walpha.tda, *with_torch):
        for name in module.__all__:
            item = getattr(module, name)
            yield name, item
            if inspect.isclass(item):
                for method, function in vars(item).items():
                    function = getattr(function, "__func__", function)
                    if not method.startswith("_") and inspect.isfunction(function):
                        yield f"{name}.{method}", function


@pytest.mark.parametrize("name", MODULES)
def test_examples_run(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if name == "torch" and not HAS_TORCH:
        pytest.skip("PyTorch is not installed")
    module = walpha if name == "__init__" else importlib.import_module(f"walpha.{name}")
    ran = doctest.testmod(module, extraglobs={"np": np, "walpha": walpha}, optionflags=doctest.NORMALIZE_WHITESPACE)
    assert ran.failed == 0
    documented = {"__init__", "_alpha_shape", "_check", "_filtration", "_pipeline", "_shape", "_many", "_triangulation", "_volume", "tda", "torch"}
    assert name not in documented or ran.attempted > 1


def test_everything_public_is_documented_and_annotated():
    seen = 0
    for name, item in public():
        text = inspect.getdoc(item)
        assert text, name
        if not inspect.isfunction(item) or getattr(item, "__module__", "") == "typing":
            continue
        seen += 1
        signature = inspect.signature(item)
        parameters = [p for p in signature.parameters.values() if p.name not in ("self", "cls")]
        assert all(p.annotation is not p.empty for p in parameters), name
        assert signature.return_annotation is not signature.empty, name
        assert "Parameters\n----------" in text or not parameters, name
        assert signature.return_annotation == "None" or "Returns\n-------" in text, name
        described = {word.strip(" *,") for line in text.split("\n") for word in line.split(" : ")[0].split(",")}
        assert {p.name for p in parameters} <= described, name
    assert seen > 40


def test_types_are_shipped():
    folder = pathlib.Path(walpha.__file__).parent
    assert (folder / "py.typed").exists() and (folder / "_walpha.pyi").exists()
    stub, real = (folder / "_walpha.pyi").read_text(), walpha._walpha
    for name, item in vars(real).items():
        if not name.startswith("_") and name != "Outline":
            assert f"class {name}:" in stub if inspect.isclass(item) else f"def {name}(" in stub, name
            for member in vars(item) if inspect.isclass(item) else ():
                assert member.startswith("_") or f"    {member}: " in stub or f"    def {member}(" in stub, (name, member)
