#!/usr/bin/env python3
"""Builds the documentation as a site: the pages of docs, the API reference of C++, C, GLSL and Python, and linked sources.

usage: site.py OUT   (`make site` writes build/site)

Copies the pages into a staging folder, where links that leave docs lead to pages with the linked source, runs Doxygen and
Sphinx with warnings as errors, and checks that every link inside the site has a target.
"""
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[1]
LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
LANGUAGES = {".py": "python", ".c": "c", ".h": "c", ".cpp": "c++", ".hpp": "c++", ".glsl": "glsl", ".comp": "glsl", ".toml": "toml",
             ".sh": "bash", ".cmake": "cmake"}
HEADERS = {"C++": ["result.hpp", "params.hpp", "effect.hpp", "atmosphere.hpp", "sky_probe.hpp", "post.hpp"], "C": ["tyndall.h"]}
PROJECT_PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")
GLSL = ["include/tyndall/light_tables.glsl", "shaders/public/atmosphere.glsl"]


class Sources:
    """Pages for files outside docs that pages link to."""

    def __init__(self, stage):
        self.stage = stage
        self.made = {}

    def page(self, path):
        """Returns the name of the page of a file or folder, in the staging folder."""
        if path in self.made:
            return self.made[path]
        name = "sources/" + (str(path.relative_to(ROOT)).replace("/", "_") or "root")
        self.made[path] = name
        out = self.stage / (name + ".md")
        out.parent.mkdir(exist_ok=True)
        title = str(path.relative_to(ROOT))
        if path.is_dir():
            files = subprocess.run(["git", "ls-files", "--", title], cwd=ROOT, capture_output=True, text=True, check=True).stdout
            out.write_text(f"---\norphan: true\n---\n\n# {title}\n\n" + "".join(f"* `{file}`\n" for file in files.split()))
        else:
            language = LANGUAGES.get(path.suffix, "none")
            out.write_text(f"---\norphan: true\n---\n\n# {title}\n\n```{{literalinclude}} {os.path.relpath(path, out.parent)}\n:language: {language}\n```\n")
        return name


def stage_page(source, target, sources, stage):
    """Copies a page, and leads links that leave docs to pages of the site."""

    def moved(match):
        text, link = match.groups()
        address, _, anchor = link.partition("#")
        if "://" in address or not address or address.startswith("mailto:"):
            return match.group(0)
        path = (source.parent / address).resolve()
        if not path.exists():
            return match.group(0)
        if path.is_relative_to(ROOT / "docs") and path.suffix != ".md" and path.is_file():
            page = None
        elif path.is_relative_to(ROOT / "docs") and path.is_file():
            page = str(path.relative_to(ROOT / "docs"))[:-3]
        elif path == ROOT / "docs" / "adr":
            page = "adr/index"
        elif path.name in PROJECT_PAGES and path.parent == ROOT:
            page = path.stem.lower()
        else:
            page = sources.page(path)
        if page is None:
            return match.group(0)
        relative = os.path.relpath(stage / (page + ".md"), target.parent)
        return f"[{text}]({relative}{'#' + anchor if anchor else ''})"

    target.parent.mkdir(parents=True, exist_ok=True)
    text = source.read_text()
    if not re.search(r"^# ", text, flags=re.M):
        text = f"# {source.stem.capitalize()}\n\n{text}"
    parts = re.split(r"(^```.*?^```)", text, flags=re.M | re.S)
    text = "".join(part if part.startswith("```") else LINK.sub(moved, part) for part in parts)
    target.write_text(text if source.is_relative_to(ROOT / "docs") else text.replace("](docs/images/", "](images/"))


def toctree(caption, pages):
    return f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n" + "\n".join(pages) + "\n```\n"


def stage_api(stage):
    api = stage / "api"
    api.mkdir()
    for language, headers in HEADERS.items():
        text = f"{language} interface\n{'=' * 20}\n\nFrom the headers in ``include/tyndall``.\n\n.. contents::\n   :local:\n   :depth: 1\n\n"
        for header in headers:
            text += f"{header}\n{'-' * 40}\n\n.. doxygenfile:: include/tyndall/{header}\n   :sections: briefdescription " \
                    "detaileddescription innerclass innernamespace define func typedef enum var public-attrib public-func " \
                    "public-static-func public-type\n\n"
        (api / f"{'c' if language == 'C' else 'cpp'}.rst").write_text(text)
    text = "GLSL interface\n==============\n\nThe headers that the shaders of an engine include; their comments document them.\n\n"
    for path in GLSL:
        text += f"{path}\n{'-' * 60}\n\n.. literalinclude:: {os.path.relpath(ROOT / path, api)}\n   :language: glsl\n\n"
    (api / "glsl.rst").write_text(text)
    (api / "python.rst").write_text("Python package\n==============\n\n.. automodule:: tyndall\n   :imported-members:\n"
                                    "   :exclude-members: Error\n\n.. py:exception:: tyndall.Error\n\n   A device failed, or there is "
                                    "none that can be used. A RuntimeError.\n")


def stage_site(stage):
    shutil.rmtree(stage, ignore_errors=True)
    sources = Sources(stage)
    pages = sorted(path for path in (ROOT / "docs").rglob("*.md"))
    for page in pages:
        stage_page(page, stage / page.relative_to(ROOT / "docs"), sources, stage)
    for name in PROJECT_PAGES:
        stage_page(ROOT / name, stage / name.lower(), sources, stage)
    for folder in ("images", "gpu"):
        shutil.copytree(ROOT / "docs" / folder, stage / folder, dirs_exist_ok=True,
                        ignore=shutil.ignore_patterns("*.md") if folder == "gpu" else None)
    decisions = sorted(path.stem for path in (ROOT / "docs" / "adr").glob("*.md"))
    (stage / "adr" / "index.md").write_text("# Design decisions\n\n```{toctree}\n:maxdepth: 1\n\n" + "\n".join(decisions) + "\n```\n")
    index = (stage / "index.md").read_text()
    for caption, part in re.findall(r"^\*\*(.+?)\*\*\n(.*?)(?=^\*\*|\Z)", index, flags=re.M | re.S):
        listed = [link[:-3] for _, link in LINK.findall(part) if link.endswith(".md") and "://" not in link]
        index += toctree(caption, listed)
    index += toctree("Reference", ["api/cpp", "api/c", "api/glsl", "api/python"]) + toctree("Project", ["readme", "contributing", "changelog"])
    listed = set(re.findall(r"^[\w/]+$", index, flags=re.M)) | {"index"} | {f"adr/{name}" for name in decisions}
    rest = [str(page.relative_to(ROOT / "docs"))[:-3] for page in pages]
    rest = [name for name in rest if name not in listed]
    if rest:
        index += toctree("Other pages", rest)
    (stage / "index.md").write_text(index)
    stage_api(stage)


def doxygen(out):
    """Writes the XML that Breathe reads."""
    out.mkdir(parents=True, exist_ok=True)
    text = (ROOT / "Doxyfile").read_text()
    text += f"\nOUTPUT_DIRECTORY = {out}\nGENERATE_XML = YES\nGENERATE_HTML = NO\nXML_PROGRAMLISTING = NO\n"
    subprocess.run(["doxygen", "-"], input=text, text=True, cwd=ROOT, check=True)


class Page(html.parser.HTMLParser):
    """The links and the anchors of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.anchors |= {found[name] for name in ("id", "name") if found.get(name)}
        self.links += [found[name] for name in ("href", "src") if found.get(name)]


def check_links(site):
    pages = {path: Page(path) for path in site.rglob("*.html")}
    broken, count = [], 0
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            anchor = urllib.parse.unquote(parts.fragment)
            if not target.exists():
                broken.append(f"{path.relative_to(site)}: {link}: there is no such page")
            elif anchor and target in pages and anchor not in pages[target].anchors:
                broken.append(f"{path.relative_to(site)}: {link}: the page has no such anchor")
    for line in broken:
        print(line, file=sys.stderr)
    if broken or count < 1000:
        raise SystemExit(f"site.py: error: {len(broken)} of {count} links have no target")
    print(f"{len(pages)} pages, {count} links inside the site, all with a target")


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    out = pathlib.Path(sys.argv[1]).resolve()
    stage, xml = out.parent / (out.name + "-source"), out.parent / (out.name + "-doxygen")
    stage_site(stage)
    doxygen(xml)
    shutil.rmtree(out, ignore_errors=True)
    environment = {**os.environ, "TYNDALL_DOXYGEN_XML": str(xml / "xml")}
    done = subprocess.run([sys.executable, "-m", "sphinx", "-b", "html", "-q", "-W", "-c", ROOT / "docs" / "site",
                           "-d", str(stage) + "-doctrees", stage, out], env=environment)
    if done.returncode:
        raise SystemExit("site.py: error: Sphinx reports warnings")
    check_links(out)


if __name__ == "__main__":
    main()
