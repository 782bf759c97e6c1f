"""The pages of the site: a frame with navigation, the notebooks by nbconvert, the gallery, the paper's equations."""

import copy
import json
import re
from html import escape
from pathlib import Path

from primer import __version__
from primer.claims import claims
from primer.view.page.collection import PAGES
from primer.view.site.words import equations, in_site, numbered, prose

_HERE = Path(__file__).parent
_NAMES = {explorer.__name__: (explorer, name, title) for explorer, (name, title, _) in PAGES.items()}
# An explorer inside of a page says how tall it is; nothing else is listened to.
_FIT = """<script>
addEventListener("message", (event) => {
  for (const frame of document.querySelectorAll("iframe"))
    if (frame.contentWindow === event.source && event.data.height > 100)
      frame.style.height = `${event.data.height + 12}px`;
});
</script>"""


def framed(title, inside, links, here, root=""):
    """A whole page: ``links`` are (address, text) of the navigation, ``here`` the address of this page."""
    head, foot = frame(title, links, here, root)
    return head + inside + foot


def frame(title, links, here, root=""):
    """(all before the text of a page, all after it)."""
    items = "".join(
        f'<li><a href="{root}{address}"{" aria-current=page" if address == here else ""}>{escape(text)}</a></li>'
        for address, text in links
    )
    head = f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<link rel="stylesheet" href="{root}site.css">
</head>
<body>
<a class="skip" href="#text">To the text</a>
<nav class="top" aria-label="Pages"><ul>{items}</ul></nav>
<main id="text">
"""
    foot = f"""
</main>
<footer><p>Made by <code>primer site</code>, version {__version__}, from the executed course: it asks nothing of the
network. After T. Barker, D. G. Schaeffer, M. Shearer, J. M. N. T. Gray, “Well-posed continuum equations for granular
flow with compressibility and μ(I)-rheology”, Proc. R. Soc. A 473 (2017), arXiv:1610.05135. Words and pictures:
CC-BY-4.0, the primer developers. Code: BSD-3-Clause.</p></footer>
{_FIT}
</body>
</html>
"""
    return head, foot


def notebook_page(path, links, here, root=""):
    """A notebook as a page, by nbconvert, with a live explorer where it has a widget."""
    import nbformat
    from nbconvert import HTMLExporter

    notebook = nbformat.read(path, as_version=4)
    title = title_of(notebook)
    exporter = HTMLExporter(template_name="template", extra_template_basedirs=[str(_HERE)])
    exporter.register_filter("markdown_with_mathml", lambda source: prose(_linked(source), root))
    head, foot = frame(title, links, here, root)
    resources = {"primer": {"head": head, "foot": foot}, "metadata": {"name": title}}
    html, _ = exporter.from_notebook_node(_with_explorers(notebook, root), resources)
    return html


def title_of(notebook):
    """Its first heading."""
    return notebook.cells[0].source.splitlines()[0].lstrip("# ")


def _linked(source):
    """Links to notebooks as links to their pages."""
    return re.sub(r"\]\(([^)\s:]+)\.(?:ipynb|md)(#[^)]*)?\)", r"](\1.html\2)", source)


def _with_explorers(notebook, root):
    notebook = copy.deepcopy(notebook)
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if "application/vnd.jupyter.widget-view+json" in data:
                output.data = {"text/html": live(data["text/plain"], root)}
    return notebook


def live(text, root=""):
    """The live explorer that an explorer's text names: ``BaseStateExplorer.from_state('a=1.5')`` and its verdict."""
    kind, call = text.splitlines()[0].split(".from_state(")
    _, name, title = _NAMES[kind]
    state = escape(call[1:-2].replace(",", "&")) if name != "pde" else ""
    address = f"{root}explore_{name}.html"
    return (
        f'<iframe src="{address}#{state}" title="Live explorer: {escape(title)}"></iframe>'
        f'<p><a href="{address}#{state}">The explorer on a page of its own</a></p>'
    )


def gallery(folder, links):
    """The figures with what they show and their numbers; ``folder`` holds the SVG, JSON and scripts."""
    parts = [prose(in_site((folder / "README.md").read_text(encoding="utf-8")))]
    for path in sorted(folder.glob("*.svg")):
        words = _docstring(path.with_suffix(".py"))
        first, rest = words[0], "\n\n".join(words[1:])
        rows = "".join(_claim(*item) for item in json.loads(path.with_suffix(".json").read_text("utf-8")).items())
        parts.append(
            f'<div class="figure" id="{path.stem}"><h2>{path.stem}</h2>'
            f'<img src="figures/{path.name}" alt="{escape(first)}" loading="lazy">'
            f"{prose(first)}{prose(rest)}<details><summary>Numbers of {path.stem}</summary>"
            f'<div class="wide" tabindex="0" role="group" aria-label="Numbers of {path.stem}"><table><thead><tr>'
            '<th scope="col">number</th><th scope="col">value</th><th scope="col">claimed</th><th scope="col">why</th>'
            f"</tr></thead><tbody>{rows}</tbody></table></div></details></div>"
        )
    return framed("Figures", "\n".join(parts), links, "figures.html")


def _docstring(script):
    import ast

    return (ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or script.stem).split("\n\n")


def _claim(name, claim):
    value = claim["value"]
    if "low" in claim:
        claimed = f"{claim['low']:.4g} to {claim['high']:.4g}"
    elif claim.get("rtol") or claim.get("atol"):
        claimed = f"± {claim['atol'] + claim['rtol'] * abs(value):.1g}"
    else:
        claimed = "exactly"
    shown = f"{value:.8g}" if isinstance(value, float) else escape(str(value))
    return f"<tr><td>{escape(name)}</td><td>{shown}</td><td>{claimed}</td><td>{escape(claim['why'])}</td></tr>"


def equations_page(links):
    """The paper's equations: number, label, and what was computed of each."""
    rows = []
    known = claims()
    for label, number in equations().items():
        about = [claim for claim in known if f"({label})" in f"{claim.where} {claim.says}"]
        said = "; ".join(f"{claim.verdict}: {claim.says}" for claim in about)
        rows.append(
            f'<tr id="{escape(label)}"><th scope="row">({number})</th><td><code>{escape(label)}</code></td>'
            f"<td>{escape(said)}</td></tr>"
        )
    text = (
        "<h1>The paper's equations by number</h1><p>Numbers are those of arXiv:1610.05135; a label is what the source "
        "of the paper calls the equation, and what the package's documentation says. Beside them, what was found of "
        'the claims that rest on them.</p><div class="wide" tabindex="0" role="group" aria-label="Equations">'
        '<table class="claimed">'
        '<thead><tr><th scope="col">number</th><th scope="col">label</th><th scope="col">claims</th></tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table></div>"
    )
    return framed("Equations of the paper", text, links, "equations.html")


def claims_page(links):
    """The ledger of the paper's claims."""
    rows = "".join(
        f"<tr><td>{numbered(escape(claim.where))}</td><td>{numbered(escape(claim.says))}</td>"
        f"<td>{numbered(escape(claim.computed))}</td><td>{escape(claim.verdict)}</td></tr>"
        for claim in claims()
    )
    names = "".join(f'<th scope="col">{name}</th>' for name in ("where", "the paper says", "computed", "verdict"))
    text = (
        '<h1>What the paper claims, and what became of it</h1><div class="wide" tabindex="0" role="group" '
        f'aria-label="Claims"><table class="claimed"><thead><tr>{names}</tr></thead><tbody>{rows}</tbody></table></div>'
    )
    return framed("Claims", text, links, "claims.html")
