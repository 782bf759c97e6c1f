"""``primer site OUT``: the whole course as static pages that open from a file, in any browser, without network.

nbconvert makes a page of each notebook, with mathematics as MathML; where a notebook has a widget the page has a live
explorer of computed states (:mod:`primer.view.page`).
"""

import re
import shutil
from concurrent.futures import ProcessPoolExecutor, as_completed
from html import escape
from pathlib import Path

import primer
from primer.view.page import save_page
from primer.view.page.collection import PAGES, page, states
from primer.view.site.pages import claims_page, equations_page, framed, gallery, notebook_page, title_of
from primer.view.site.words import in_site, possible, prose

_HERE = Path(__file__).parent
_ROOT = Path(primer.__file__).resolve().parents[1]  # of a clone; in an installed package there are no figures


def build(out, notebooks, explorers=None, progress=None):
    """Write the site into the folder ``out``; return the names of its files.

    notebooks    the folder of the course
    explorers    a folder whose explorer pages are taken, instead of making them in some minutes
    progress     wraps the loop over the explorers

    Raises
    ------
    ValueError    if out cannot be written, or what makes the pages is not installed
    """
    if not possible():
        raise ValueError("nbconvert and latex2mathml must be installed to make pages: python -m pip install -e .")
    out, notebooks = Path(out), Path(notebooks)
    try:
        (out / "solutions").mkdir(parents=True, exist_ok=True)
        return _build(out, notebooks, explorers and Path(explorers), progress or iter)
    except OSError as error:
        raise ValueError(f"OUT must be a folder that can be written, got {str(out)!r} ({error.strerror})") from None


def _build(out, notebooks, explorers, progress):
    lessons = sorted(notebooks.glob("[0-9]*.ipynb"))
    figures, readme = _ROOT / "figures", _ROOT / "README.md"
    links = [("index.html", "Start"), *((f"{path.stem}.html", path.stem[:2]) for path in lessons)]
    links += [(f"explore_{name}.html", name.replace("_", " ")) for name, _, _ in PAGES.values()]
    links += [("figures.html", "Figures")] if figures.is_dir() else []
    links += [("equations.html", "Equations"), ("claims.html", "Claims")]
    shutil.copyfile(_HERE / "site.css", out / "site.css")
    pages = {f"{path.stem}.html": notebook_page(path, links, f"{path.stem}.html") for path in lessons}
    for path in sorted((notebooks / "solutions").glob("*.ipynb")):
        here = f"solutions/{path.stem}.html"
        pages[here] = notebook_page(path, links, here, "../")
    pages |= {"equations.html": equations_page(links), "claims.html": claims_page(links)}
    for name, title in (("INSTRUCTORS", "For instructors"), ("CORRECTIONS", "Where the paper is corrected")):
        text = in_site((notebooks / f"{name}.md").read_text(encoding="utf-8"))
        pages[f"{name}.html"] = framed(title, prose(text), links, f"{name}.html")
    if figures.is_dir():
        (out / "figures").mkdir(exist_ok=True)
        for path in (*figures.glob("*.svg"), *figures.glob("*.gif"), *figures.glob("*.png")):
            shutil.copyfile(path, out / "figures" / path.name)
        pages["figures.html"] = gallery(figures, links)
    pages["index.html"] = _index(readme, lessons, links)
    for name, html in pages.items():
        (out / name).write_text(html, encoding="utf-8", newline="\n")
    _explorers(out, explorers, progress)
    return sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file())


def _explorers(out, ready, progress):
    """The live explorers, two at a time on two cores."""
    names = {name: explorer for explorer, (name, _, _) in PAGES.items()}
    if ready:
        for name in names:
            shutil.copyfile(ready / f"explore_{name}.html", out / f"explore_{name}.html")
        return
    with ProcessPoolExecutor() as pool:
        waiting = [pool.submit(_explorer, explorer, out / f"explore_{name}.html") for name, explorer in names.items()]
        for done in progress(as_completed(waiting)):
            done.result()


def _explorer(explorer, path):
    save_page(page(states(explorer)), path)


def _index(readme, lessons, links):
    rows = "".join(f'<li><a href="{path.stem}.html">{escape(_title(path))}</a></li>' for path in lessons)
    live = "".join(f'<li><a href="explore_{name}.html">{escape(title)}</a></li>' for name, title, _ in PAGES.values())
    text = f"<h2>The course</h2><ul>{rows}</ul><h2>Live explorers</h2><ul>{live}</ul>"
    if not readme.exists():
        return framed("primer", "<h1>primer: ill-posed PDEs</h1>" + text, links, "index.html")
    before, *after = re.split(r"(?=^## )", in_site(readme.read_text(encoding="utf-8")), maxsplit=1, flags=re.M)
    return framed("primer", prose(before) + text + prose("".join(after)), links, "index.html")


def _title(path):
    import nbformat

    return title_of(nbformat.read(path, as_version=4))
