"""A notebook as slides, a heading or a picture each, and the same page on paper as a handout: HTML without network."""

import re
from html import escape

import nbformat

from primer.view.site.words import prose

_CSS = """
body { margin: 0; font: 1.3rem/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; }
section { box-sizing: border-box; padding: 2rem 4vw 3rem; }
pre { font: .95rem/1.45 ui-monospace, monospace; background: #f5f5f3; padding: .6rem; white-space: pre-wrap; }
pre.said { background: none; border-left: 3px solid #767676; }
img { max-width: 100%; height: auto; } p, li { max-width: 60rem; } h1, h2, h3 { line-height: 1.2; }
table { border-collapse: collapse; } td, th { border: 1px solid #ddd; padding: .2rem .5rem; text-align: left; }
.wide { overflow-x: auto; } a { color: #005a92; }
.slides section { display: none; min-height: 100vh; } .slides section.here { display: block; }
#place { position: fixed; right: 1rem; bottom: .6rem; font-size: .9rem; color: #595959; }
@media print { .slides section { display: block; min-height: 0; break-inside: avoid; padding: .5rem 0; }
  body { font-size: 11pt; } #place { display: none; } }
"""
_JS = """
const slides = [...document.querySelectorAll("section")];
const at = () => Math.min(Math.max(Number(location.hash.slice(1)) || 1, 1), slides.length);
function show() {
  slides.forEach((slide, k) => slide.classList.toggle("here", k + 1 === at()));
  document.getElementById("place").textContent = `${at()} / ${slides.length}`;
  scrollTo(0, 0);
}
addEventListener("hashchange", show);
addEventListener("keydown", (event) => {
  const by = { ArrowRight: 1, PageDown: 1, " ": 1, ArrowLeft: -1, PageUp: -1 }[event.key];
  if (by) { event.preventDefault(); location.hash = Math.min(Math.max(at() + by, 1), slides.length); }
});
show();
"""


def pages(path):
    """(slides, handout): two HTML pages of an executed notebook, each whole in itself."""
    notebook = nbformat.read(path, as_version=4)
    title = notebook.cells[0].source.splitlines()[0].lstrip("# ")
    sections = _sections(notebook)
    body = "\n".join(f"<section>\n{section}\n</section>" for section in sections)
    script = f'<p id="place" aria-live="polite"></p><script>{_JS}</script>'
    return _page(title, "slides", body + script), _page(title, "handout", body)


def _page(title, kind, body):
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
        f'<style>{_CSS}</style>\n</head>\n<body class="{kind}">\n{body}\n</body>\n</html>\n'
    )


def _sections(notebook):
    """A slide begins at each heading, and at each cell with a picture."""
    found: list[list[str]] = [[]]
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            for part in re.split(r"^(?=#{1,3} )", cell.source, flags=re.M):
                alone = re.fullmatch(r"\s*<h\d.*</h\d>\s*", "".join(found[-1]))  # a heading over the next heading
                if part.startswith("#") and any(found[-1]) and not alone:
                    found.append([])
                found[-1].append(_without_links(prose(part)))
            continue
        shown = [_output(output) for output in cell.outputs]
        if any("<img " in text for text in shown):
            found.append([])
        found[-1] += [f"<pre>{escape(cell.source)}</pre>", *shown]
    return ["\n".join(section) for section in found if any(text.strip() for text in section)]


def _output(output):
    data = output.get("data", {})
    if "<img " in data.get("text/html", "") and "application/vnd.jupyter.widget-view+json" not in data:
        return data["text/html"]
    return f'<pre class="said">{escape(output.get("text", "") or data.get("text/plain", ""))}</pre>'


def _without_links(html):
    """Links into a site or a folder that is not here become their text; those of the web stay."""
    html = re.sub(r'<a class="anchor-link".*?</a>', "", html, flags=re.S)
    return re.sub(r'<a [^>]*href="(?!https?:)[^"]*"[^>]*>(.*?)</a>', r"\1", html, flags=re.S)
