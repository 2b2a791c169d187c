#!/usr/bin/env python3
"""Makes a website of the book, the folder docs, in target/book, and ends with 1 if a link in it is dead.

Needs mdBook, which it installs into target/tools with cargo if it is not there (about a minute). Otherwise only Python's standard library.
"""

import html.parser
import os
import pathlib
import shutil
import subprocess
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent
BOOK = ROOT / "target" / "book"
VERSION = "0.5.4"


class Page(html.parser.HTMLParser):
    """The links and the names of places in a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.places = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if attributes.get("id"):
            self.places.add(attributes["id"])
        link = attributes.get("href") if tag == "a" else attributes.get("src") if tag == "img" else None
        if link:
            self.links.append(link)


def mdbook():
    """The program, installed if it is not there."""
    own = ROOT / "target" / "tools" / "bin" / "mdbook"
    found = shutil.which("mdbook") or (str(own) if own.exists() else None)
    if not found:
        # Nobody waits for the book, so its program need not be optimized.
        environment = dict(os.environ, CARGO_PROFILE_RELEASE_OPT_LEVEL="0")
        subprocess.run(["cargo", "install", "mdbook", "--version", VERSION, "--locked", "--no-default-features",
                        "--root", str(ROOT / "target" / "tools")], env=environment, check=True)
        found = str(own)
    return found


def dead_links(pages):
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            place = urllib.parse.unquote(parts.fragment)
            is_there = target.is_file() and BOOK in target.parents
            if not is_there or (place and target in pages and place not in pages[target].places):
                yield f"{path.relative_to(BOOK)}: {link}"


def main():
    shutil.rmtree(BOOK, ignore_errors=True)
    subprocess.run([mdbook(), "build", str(ROOT / "docs")], check=True)
    # The page for wrong addresses has a base of its own, and the page to print repeats all others.
    own = [path for path in BOOK.rglob("*.html") if path.name not in ("404.html", "print.html", "toc.html")]
    pages = {path: Page(path.read_text()) for path in own}
    dead = sorted(set(dead_links(pages)))
    if len(pages) < 30:
        raise SystemExit(f"only {len(pages)} pages in {BOOK}")
    if dead:
        raise SystemExit("dead links:\n" + "\n".join(dead))
    print(f"{BOOK.relative_to(ROOT)}/index.html: {len(pages)} pages, {sum(len(page.links) for page in pages.values())} links, none is dead")


if __name__ == "__main__":
    main()
