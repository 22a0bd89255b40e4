#!/usr/bin/env python3
"""Makes docs/python-api.md: the signature and the docstring of every public function and class of the Python package, as Markdown.

    python3 scripts/python_api.py          # the page is what the sources say: exit code 1 where it is not
    python3 scripts/python_api.py write    # write it

It reads the sources, so nothing has to be built or installed. Docstrings are those of numpydoc. Standard library only.
"""

import ast
import inspect
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python/walpha"
PAGE = ROOT / "docs/python-api.md"
HEAD = """# Python, every function

What `help(walpha)` says, made from the docstrings by `scripts/python_api.py`. [Python](python.md) is the introduction. In signatures `Arrays` is whatever numpy takes or has DLPack, and
`Floats`, `Indices` and `Samples` are arrays of float64, int64 and float32. `Progress` and `threads` are explained at [`alpha_shape`](#alpha_shape).
"""
#: Sections whose entries have a name or a type each.
ENTRIES = ("Parameters", "Attributes", "Returns", "Raises", "Warns")
#: Longest signature on one line.
WIDTH = 100


class Sources:
    """The modules of the package, parsed."""

    def __init__(self):
        self.lines = {path.stem: path.read_text(encoding="utf-8").splitlines() for path in PACKAGE.glob("*.py")}
        self.trees = {name: ast.parse("\n".join(lines)) for name, lines in self.lines.items()}

    def public(self, module):
        """The names in `__all__`."""
        for node in self.trees[module].body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
                return ast.literal_eval(node.value)
        raise SystemExit(f"{module} has no __all__")

    def find(self, name, module):
        """Where something is defined that a module defines or imports: module and node; None if it is not of the package."""
        for node in self.trees[module].body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name == name:
                return module, node
            if isinstance(node, ast.ImportFrom) and node.level == 1 and any(alias.name == name for alias in node.names):
                return self.find(name, node.module) if node.module in self.trees else None
        return None

    def members(self, module, node):
        """What a class has, first its own and then what it inherits, without what begins with an underscore."""
        seen = {}
        for member in node.body:
            if isinstance(member, ast.FunctionDef) and not member.name.startswith("_") and "overload" not in decorators(member):
                seen[member.name] = member
        for base in node.bases:
            found = self.find(ast.unparse(base), module)
            if found:
                seen = {**self.members(*found), **seen}
        return seen

    def constants(self, module, node):
        """Names in the body of a class, with the comment `#:` above each."""
        for member in node.body:
            above = self.lines[module][member.lineno - 2].strip()
            if isinstance(member, ast.Assign) and above.startswith("#:"):
                yield ast.unparse(member), above.removeprefix("#:").strip()


def decorators(node):
    """The last parts of the names of the decorators."""
    return {ast.unparse(decorator).split("(")[0].split(".")[-1] for decorator in node.decorator_list}


def signature(name, arguments, returned=None):
    """A signature as a block of code, without `self`."""
    end = f" -> {ast.unparse(returned)}" if returned else ""
    line = f"{name}({', '.join(arguments)}){end}"
    if len(line) > WIDTH:
        line = f"{name}(\n    " + ",\n    ".join(arguments) + f",\n){end}"
    return f"```python\n{line.replace(chr(39), chr(34))}\n```"


def arguments(node):
    """The arguments of a function as it writes them, but for `self`."""
    given = node.args
    positional = given.posonlyargs + given.args
    defaults = [None] * (len(positional) - len(given.defaults)) + given.defaults

    def one(argument, default):
        annotation = f": {ast.unparse(argument.annotation)}" if argument.annotation else ""
        equals = " = " if annotation else "="
        return argument.arg + annotation + ("" if default is None else equals + ast.unparse(default))

    made = [one(argument, default) for argument, default in zip(positional, defaults) if argument.arg not in ("self", "cls")]
    if given.vararg:
        made.append(f"*{one(given.vararg, None)}")
    elif given.kwonlyargs:
        made.append("*")
    made += [one(argument, default) for argument, default in zip(given.kwonlyargs, given.kw_defaults)]
    if given.kwarg:
        made.append(f"**{one(given.kwarg, None)}")
    return made


class Markdown:
    """Turns docstrings into Markdown, with links to the headings of the page, which are given in order."""

    def __init__(self, headings):
        # Their anchors, as mdBook and GitHub make them.
        self.anchors = {}
        for heading in headings:
            plain = heading.lower().replace(".", "")
            count = list(self.anchors.values()).count(plain)
            self.anchors[heading] = f"{plain}-{count}" if count else plain

    def link(self, heading, shown):
        return f"[`{shown}`](#{self.anchors[heading]})"

    def inline(self, text, owner):
        """A paragraph on one line."""
        # Code and roles are set aside, as nothing in them is markup.
        kept = []

        def keep(made):
            kept.append(made)
            return f"\0{len(kept) - 1}\0"

        def role(match):
            name = match[1].removeprefix("walpha.")
            module = owner.rpartition(".")[0]
            for heading in (f"{owner}.{name}", f"{module}.{name}", name, name.split(".")[0]):
                if heading in self.anchors:
                    return keep(self.link(heading, name))
            return keep(f"`{name}`")

        text = re.sub(r":(?:class|meth|func|attr):`([^`]+)`", role, " ".join(text.split()))
        text = re.sub(r"``(.+?)``|`(.+?)`", lambda match: keep(f"`{match[1] or match[2]}`"), text)
        text = re.sub(r"(?<!\w)_|_(?!\w)", r"\_", text.replace("<", "&lt;"))
        return re.sub("\0(\\d+)\0", lambda match: kept[int(match[1])], text)

    def paragraphs(self, lines, owner):
        """Text and examples."""
        made, text, code = [], [], []

        def flush():
            if text:
                made.append(self.inline("\n".join(text), owner))
                text.clear()
            if code:
                made.append("```python\n" + "\n".join(code) + "\n```")
                code.clear()

        for line in [*lines, ""]:
            if line.startswith(">>>") and not code:
                flush()
            if not line.strip():
                flush()
            elif code or line.startswith(">>>"):
                code.append(line)
            else:
                text.append(line)
        return made

    def entries(self, lines, owner, section):
        """Entries of a section as a list."""
        made, name, text = [], None, []

        def flush():
            if name is None:
                return
            head, _, kind = name.partition(" : ")
            if kind or section != "Returns":
                shown = ", ".join(f"`{part.strip()}`" for part in head.split(","))
            else:
                # What is returned has a type, and seldom a name.
                shown = self.link(head, head) if head in self.anchors else self.inline(head, owner)
            described = self.inline("\n".join(text), owner)
            made.append(f"- {shown}" + (f" ({self.inline(kind, owner)})" if kind else "") + (f": {described}" if described else ""))

        for line in lines:
            if line and not line.startswith(" "):
                flush()
                name, text = line, []
            else:
                text.append(line)
        flush()
        return "\n".join(made)

    def blocks(self, docstring, owner):
        """A docstring, as blocks of Markdown."""
        lines = inspect.cleandoc(docstring).splitlines()
        starts = [k for k in range(len(lines) - 1) if lines[k + 1].startswith("---") and not lines[k].startswith(" ")]
        made = self.paragraphs(lines[: starts[0] if starts else None], owner)
        for start, end in zip(starts, [*starts[1:], len(lines)]):
            section, body = lines[start], lines[start + 2 : end]
            made.append(f"**{section}**")
            made += [self.entries(body, owner, section)] if section in ENTRIES else self.paragraphs(body, owner)
        return made


def is_property(node):
    return bool(decorators(node) & {"property", "cached_property"})


def summary(docstring):
    """The first sentence."""
    first = inspect.cleandoc(docstring).split("\n\n")[0]
    return re.split(r"(?<=[.:])\s", " ".join(first.split()))[0].rstrip(".:")


def fields(node):
    """The fields of a dataclass, as its constructor takes them."""
    made = [member for member in node.body if isinstance(member, ast.AnnAssign) and not member.target.id.startswith("_")]
    return [ast.unparse(member) for member in made]


def titled(prefix, node):
    """A name as it is written after `walpha.`: several modules may have the same."""
    return prefix.removeprefix("walpha.") + node.name


def of_class(sources, markdown, prefix, module, node):
    """The blocks of a class, below its heading."""
    title = titled(prefix, node)
    members = sources.members(module, node)
    docstring = ast.get_docstring(node)
    made = []
    if "Parameters\n---" in docstring:
        starts = [member for member in node.body if isinstance(member, ast.FunctionDef) and member.name == "__init__"]
        made.append(signature(prefix + node.name, arguments(starts[0]) if starts else fields(node)))
    made += markdown.blocks(docstring, title)
    constants = [f"- `{written}`: {markdown.inline(text, title)}" for written, text in sources.constants(module, node)]
    if constants:
        made.append("\n".join(constants))
    properties = []
    for name, member in members.items():
        if is_property(member):
            first, *rest = markdown.blocks(ast.get_docstring(member), title)
            kind, colon, text = first.partition(": ")
            head = f"- `{name}` ({kind}): {text}" if colon else f"- `{name}` ({kind.rstrip('.')})"
            properties.append("\n\n".join([head, *(re.sub("(?m)^", "  ", block) for block in rest)]))
    if properties:
        made += ["**Properties**", "\n".join(properties)]
    for name, member in members.items():
        if not is_property(member):
            made.append(f"### {title}.{name}")
            made.append(signature(f"{node.name}.{name}", arguments(member), member.returns))
            made += markdown.blocks(ast.get_docstring(member), title)
    return made


def page():
    sources = Sources()
    parts = [("walpha.", *sources.find(name, "__init__")) for name in sources.public("__init__")]
    for module in ("tda", "torch"):
        parts += [(f"walpha.{module}.", *sources.find(name, module)) for name in sources.public(module)]
    parts.sort(key=lambda part: (isinstance(part[2], ast.ClassDef), part[2].name.lower()))
    headings = []
    for prefix, module, node in parts:
        title = titled(prefix, node)
        headings.append(title)
        if isinstance(node, ast.ClassDef):
            headings += [f"{title}.{name}" for name, member in sources.members(module, node).items() if not is_property(member)]
    markdown = Markdown(headings)
    made = [HEAD.strip()]
    for title, is_class in (("Functions", False), ("Classes", True)):
        rows = [
            f"| {markdown.link(titled(prefix, node), titled(prefix, node))} | {markdown.inline(summary(ast.get_docstring(node)), node.name)} |"
            for prefix, _, node in parts
            if isinstance(node, ast.ClassDef) == is_class
        ]
        made += [f"**{title}**", "| name | summary |\n|---|---|\n" + "\n".join(rows)]
    for prefix, module, node in parts:
        made.append(f"## {titled(prefix, node)}")
        if isinstance(node, ast.ClassDef):
            made += of_class(sources, markdown, prefix, module, node)
        else:
            made.append(signature(prefix + node.name, arguments(node), node.returns))
            made += markdown.blocks(ast.get_docstring(node), titled(prefix, node))
    return "\n\n".join(made) + "\n"


def main():
    made = page()
    if sys.argv[1:] == ["write"]:
        PAGE.write_text(made, encoding="utf-8")
    elif not PAGE.exists() or PAGE.read_text(encoding="utf-8") != made:
        sys.exit(f"{PAGE.relative_to(ROOT)} is not what the docstrings say: run scripts/python_api.py write")


if __name__ == "__main__":
    main()
