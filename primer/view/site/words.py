"""Prose of the course as HTML that needs no network: mathematics as MathML, equations of the paper by their numbers."""

import csv
import re
from functools import lru_cache
from html import escape
from importlib.util import find_spec
from pathlib import Path

_EQUATIONS = Path(__file__).with_name("equations.tsv")


def possible():
    """Whether pages can be made here: nbconvert comes with JupyterLab, latex2mathml with the package."""
    return all(map(find_spec, ("nbconvert", "latex2mathml")))


@lru_cache(maxsize=1)
def equations():
    """Label -> number of the paper's equations in arXiv:1610.05135, which the published version shares."""
    with open(_EQUATIONS, encoding="utf-8", newline="") as file:
        return {row["label"]: row["number"] for row in csv.DictReader(file, delimiter="\t")}


def mathml(text, display):
    """TeX as MathML, with the TeX itself for who copies it or has it read out."""
    from latex2mathml.converter import convert

    made = convert(text, display="block" if display else "inline")
    made = made.replace("<math ", f'<math alttext="{escape(" ".join(text.split()))}" ', 1)
    return f'<div class="wide" tabindex="0" role="group" aria-label="Equation">{made}</div>' if display else made


@lru_cache(maxsize=1)
def _markdown():
    from nbconvert.filters.markdown_mistune import IPythonRenderer, MarkdownWithMath

    class Renderer(IPythonRenderer):
        """nbconvert's own, but for mathematics."""

        def block_math(self, body):
            return mathml(body, display=True)

        def multiline_math(self, text):
            return mathml(text.strip().strip("$"), display=True)

        def latex_environment(self, name, body):
            return mathml(rf"\begin{{{name}}}{body}\end{{{name}}}", display=True)

        def inline_math(self, body):
            return mathml(body, display=False)

    return lambda: MarkdownWithMath(renderer=Renderer(escape=False))


def prose(source, root=""):
    """Markdown as HTML; ``root`` leads from the page to the site's first folder."""
    html = _markdown()().render(source)
    html = re.sub(
        r"<table>.*?</table>",
        r'<div class="wide" tabindex="0" role="group" aria-label="Table">\g<0></div>',
        html,
        flags=re.S,
    )
    return numbered(html, root)


def numbered(html, root=""):
    """Labels of the paper's equations as links that show their numbers: (toy-mat) becomes (82), its label beside."""
    known = "|".join(map(re.escape, sorted(equations(), key=len, reverse=True)))
    label = re.compile(rf"(?:\((\d+[a-e]?)\)\s+)?\(({known})\)(?:, \((\d+[a-e]?)\))?")

    def link(found):
        number = equations()[found[2]]
        return (
            f'<span class="equation"><a href="{root}equations.html#{found[2]}">({number})</a> '
            f'<span class="label">{found[2]}</span></span>'
        )

    parts = re.split(r"(<math.*?</math>|<pre.*?</pre>|<code.*?</code>|<a .*?</a>|<[^>]+>)", html, flags=re.S)
    return "".join(part if part.startswith("<") else label.sub(link, part) for part in parts)


def in_site(text):
    """Links of the repository's Markdown as links within the site; where they lead out of it, their text alone."""
    for old, new in (
        (r"(?:notebooks/)?(?P<to>(?:solutions/)?\d\d_\w+|INSTRUCTORS|CORRECTIONS)\.(?:ipynb|md)", r"\g<to>.html"),
        (r"(?:figures/)?README\.md", "figures.html"),
        (r"(?:figures/)?explorer\.html", "explore_base_state.html"),
        (r"(?:figures/)?(?P<to>\w+)\.svg", r"figures.html#\g<to>"),
    ):
        text = re.sub(rf"(?<!!)(?P<text>\[[^\[\]]*\])\({old}\)", rf"\g<text>({new})", text)
    return re.sub(r"(?<!!)\[([^\[\]]*)\]\((?!https?:|#|[\w/]+\.html)[^)]*\)", r"\1", text)
