"""The mutants: every small change of a module's syntax tree, and an import hook that loads a module so changed."""

import ast
import importlib.abc
import importlib.machinery
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAIRS = "Lt LtE,Gt GtE,Eq NotEq,Is IsNot,In NotIn,Add Sub,Mult Div,And Or,BitAnd BitOr,Pow Mult,FloorDiv Mult,Mod Mult"
SWAP = {}
for one, two in (pair.split() for pair in PAIRS.split(",")):
    SWAP.setdefault(getattr(ast, two), getattr(ast, one))
    SWAP[getattr(ast, one)] = getattr(ast, two)


def changes(node):
    """The nodes that may stand in for ``node``."""
    if isinstance(node, ast.Compare):
        for i, op in enumerate(node.ops):
            yield ast.Compare(node.left, [*node.ops[:i], SWAP[type(op)](), *node.ops[i + 1 :]], node.comparators)
    elif isinstance(node, ast.BinOp) and type(node.op) in SWAP:
        yield ast.BinOp(node.left, SWAP[type(node.op)](), node.right)
    elif isinstance(node, ast.AugAssign) and type(node.op) in SWAP:
        yield ast.AugAssign(node.target, SWAP[type(node.op)](), node.value)
    elif isinstance(node, ast.BoolOp):
        yield ast.BoolOp(SWAP[type(node.op)](), node.values)
    elif isinstance(node, ast.UnaryOp):
        yield node.operand
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield ast.Constant(not node.value)
    elif isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        yield from (ast.Constant(node.value + 1), ast.Constant(node.value - 1))
    elif isinstance(node, (ast.If, ast.IfExp, ast.While)):
        yield type(node)(ast.UnaryOp(ast.Not(), node.test), node.body, node.orelse)
    elif isinstance(node, ast.Return) and ast.unparse(node) not in ("return", "return None"):
        yield ast.Return(ast.Constant(None))
    elif isinstance(node, (ast.Raise, ast.Continue, ast.Break)) or (
        isinstance(node, ast.Expr) and not isinstance(node.value, ast.Constant)
    ):
        yield ast.Pass()


def places(node):
    """(parent, field, place in a list or None, child) of all descendants, annotations and their like left out."""
    for field, value in ast.iter_fields(node):
        for i, child in enumerate(value if isinstance(value, list) else [value]):
            if isinstance(child, ast.AST) and field not in ("annotation", "returns"):
                yield node, field, i if isinstance(value, list) else None, child
                yield from places(child)


def mutants(folder):
    """Every mutant of a folder: (file, number, first line, last line, what, column)."""
    for path in sorted((ROOT / "primer" / folder).glob("*.py")):
        found = ((child, new) for *_, child in places(ast.parse(path.read_text("utf-8"))) for new in changes(child))
        for number, (old, new) in enumerate(found):
            seen = getattr(old, "test", old)
            what = f"{ast.unparse(old)}  ->  {ast.unparse(ast.fix_missing_locations(new))}"
            yield path.relative_to(ROOT).as_posix(), number, seen.lineno, seen.end_lineno, what, seen.col_offset


class Spoil(importlib.abc.MetaPathFinder, importlib.machinery.SourceFileLoader):
    """Finds and loads the one module that is changed; with the number -1 it is left as it is."""

    def __init__(self, file, number):
        super().__init__(file.removesuffix(".py").removesuffix("/__init__").replace("/", "."), str(ROOT / file))
        self.number = number

    def find_spec(self, name, path=None, target=None):
        return importlib.machinery.ModuleSpec(name, self, origin=self.path) if name == self.name else None

    def get_code(self, name):
        tree = ast.parse(Path(self.path).read_text("utf-8"))
        if self.number >= 0:
            every = [(place, new) for place in places(tree) for new in changes(place[-1])]
            (parent, field, i, old), new = every[self.number]
            ast.fix_missing_locations(ast.copy_location(new, old))
            setattr(parent, field, new) if i is None else getattr(parent, field).__setitem__(i, new)
        return compile(tree, self.path, "exec")
