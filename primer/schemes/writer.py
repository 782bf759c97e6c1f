"""A writer of LLVM's intermediate representation: registers, loops, branches.

>>> write = Writer()
>>> with write.function("twice", "ptr %a, i64 %n"), write.loop("0", "%n") as (i, _, _):
...     place = write.at("double", "%a", i)
...     x = write.load("double", place)
...     write.store("double", write.value(f"fadd double {x}, {x}"), place)
>>> write.text.count("fadd")
1
"""

from contextlib import contextmanager


class Writer:
    """Lines of text, a function at a time; the same text twice in a block without a branch is the same value."""

    def __init__(self):
        self._lines, self._count, self._block, self._known = [], 0, "", {}

    @property
    def text(self):
        """What has been written."""
        return "\n".join(self._lines) + "\n"

    def _name(self, stem):
        self._count += 1
        return f"{stem}{self._count}"

    def declare(self, line):
        """Write a line that stands outside of functions."""
        self._lines.append(line)

    def put(self, line):
        """Write a line that has no value."""
        self._lines.append("  " + line)

    def value(self, text):
        """The register that holds the value of ``text``, which depends on its operands alone."""
        if text not in self._known:
            self._known[text] = self.effect(text)
        return self._known[text]

    def effect(self, text):
        """The same for what may differ each time, such as what is loaded from memory that changes."""
        register = self._name("%r")
        self.put(f"{register} = {text}")
        return register

    def at(self, kind, base, index):
        """The address of base[index]."""
        return self.value(f"getelementptr {kind}, ptr {base}, i64 {index}")

    def load(self, kind, place):
        """What is at an address, in a vector of any alignment."""
        return self.effect(f"load {kind}, ptr {place}, align {_alignment(kind)}")

    def store(self, kind, value, place):
        """Put a value at an address."""
        self.put(f"store {kind} {value}, ptr {place}, align {_alignment(kind)}")

    def _label(self, label):
        self._lines.append(f"{label}:")
        self._block, self._known = label, {}

    def variable(self, kind, value):
        """The address of a variable with a first value; for functions that are called rarely, or loops that are."""
        place = self.effect(f"alloca {kind}")
        self.store(kind, value, place)
        return place

    @contextmanager
    def function(self, name, arguments, linkage=""):
        """A function without a result."""
        self._lines.append(f"define {linkage} void @{name}({arguments}) {{")
        self._label("entry")
        yield
        self.put("ret void")
        self._lines.append("}")

    @contextmanager
    def loop(self, start, stop, step=1, carried=()):
        """i from start to stop; ``carried`` are (kind, first value); gives (i, their values, a list for the next)."""
        head, body, done = self._name("head"), self._name("body"), self._name("done")
        i, following, before = self._name("%i"), self._name("%n"), self._block
        self.put(f"br label %{head}")
        self._label(head)
        place = len(self._lines)
        values = [self._name("%c") for _ in carried]
        more = self.effect(f"icmp slt i64 {i}, {stop}")
        self.put(f"br i1 {more}, label %{body}, label %{done}")
        self._label(body)
        next_values = list(values)
        yield i, values, next_values
        last = self._block
        self.put(f"{following} = add i64 {i}, {step}")
        self.put(f"br label %{head}")
        merge = [f"  {i} = phi i64 [ {start}, %{before} ], [ {following}, %{last} ]"]
        for (kind, first), value, then in zip(carried, values, next_values, strict=True):
            merge.append(f"  {value} = phi {kind} [ {first}, %{before} ], [ {then}, %{last} ]")
        self._lines[place:place] = merge
        self._label(done)

    @contextmanager
    def loop_while(self, condition):
        """As long as ``condition()``, which writes what it needs, gives a true register."""
        head, body, done = self._name("head"), self._name("body"), self._name("done")
        self.put(f"br label %{head}")
        self._label(head)
        self.put(f"br i1 {condition()}, label %{body}, label %{done}")
        self._label(body)
        yield
        self.put(f"br label %{head}")
        self._label(done)

    @contextmanager
    def when(self, condition):
        """Where a register is true."""
        then, done = self._name("then"), self._name("done")
        self.put(f"br i1 {condition}, label %{then}, label %{done}")
        self._label(then)
        yield
        self.put(f"br label %{done}")
        self._label(done)

    def leave_if(self, condition):
        """Return from the function where a register is true."""
        out, on = self._name("out"), self._name("on")
        self.put(f"br i1 {condition}, label %{out}, label %{on}")
        self._label(out)
        self.put("ret void")
        self._label(on)


def _alignment(kind):
    """Of the parts of a vector."""
    part = kind.strip("<>").split()[-1]
    return {"float": 4}.get(part, 8)
