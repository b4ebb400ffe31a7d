#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Is a site whole? Every link inside it leads somewhere, nothing is fetched from elsewhere, no script is a module, and
every public name has its place.

usage: check.py SITE DOXYGEN-XML EXPORTS
"""

import functools
import html.parser
import pathlib
import re
import sys
import urllib.parse
import xml.etree.ElementTree


def fetched_by_style(text):
    """Yield the addresses that a style sheet fetches."""
    text = re.sub(r'/\*.*?\*/', ' ', text, flags=re.S)
    for matches in re.findall(r"""(?:@import\s*|\burl\(\s*)(?:"([^"]*)"|'([^']*)')|\burl\(\s*([^"')\s]+)""", text, re.I):
        yield from filter(None, matches)


@functools.cache
def is_module(script):
    """Does the text of a script import or export? If so, it fails in a page that includes it as a classic script."""
    return re.search(r"""(?:^|;)\s*(?:import|export)\b\s*[\w{*"']""", script.read_text(), re.M)


class Page(html.parser.HTMLParser):
    """The anchors of a page and what it links to: (address, does a browser fetch it by itself?)."""

    def __init__(self, path):
        super().__init__()
        self.anchors = set()
        self.links = []
        self.style = ''
        self.has_module = False
        self.feed(path.read_text())
        self.links += ((address, True) for address in fetched_by_style(self.style))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(attributes[name] for name in ('id', 'name') if name in attributes)
        for name in ('href', 'src'):
            if attributes.get(name):
                self.links.append((attributes[name], tag != 'a'))
        # Addresses, each with a width or a density behind it or not; one may have commas in it.
        for address in re.findall(r'([^\s,]\S*[^\s,])(?:\s+[\d.]+[wx])?\s*(?:,|$)', attributes.get('srcset') or ''):
            self.links.append((address, True))
        self.has_module |= tag == 'script' and attributes.get('type') == 'module'
        self.style += f" {attributes.get('style') or ''}"

    def handle_data(self, data):
        if self.cdata_elem == 'style':
            self.style += data


def public_names(doxygen):
    """Yield (anchor, name) of all that Doxygen has found in the headers."""
    for file in sorted(doxygen.glob('*.xml')):
        for element in xml.etree.ElementTree.parse(file).iter():
            if element.tag in ('memberdef', 'enumvalue'):
                yield element.get('id'), element.findtext('name')
            elif element.tag == 'compounddef' and element.get('kind') == 'struct':
                yield element.get('id'), element.findtext('compoundname')


def faults(site, doxygen, exports):
    """Yield a sentence for each thing that is wrong."""
    pages = {path: Page(path) for path in sorted(site.rglob('*.html'))}
    links = {path: page.links for path, page in pages.items()}
    links |= {path: [(address, True) for address in fetched_by_style(path.read_text())] for path in sorted(site.rglob('*.css'))}
    for path in links:
        for address, fetched in links[path]:
            parts = urllib.parse.urlsplit(address)
            if parts.scheme in ('http', 'https', 'data', 'mailto') or parts.netloc:
                if fetched and parts.scheme != 'data':
                    yield f'{path}: fetches {address}'
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file():
                yield f'{path}: no file for {address}'
            elif parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                yield f'{path}: no anchor for {address}'
            elif fetched and target.suffix == '.js' and is_module(target):
                yield f'{path}: {address} imports or exports, as only modules can'
    # Browsers do not load modules from a disk.
    yield from (f'{path}: includes a module' for path, page in pages.items() if page.has_module)
    anchors = set().union(*(page.anchors for page in pages.values()))
    names = list(public_names(doxygen))
    yield from (f'{name} is in a header and in no page' for anchor, name in names if anchor not in anchors)
    exported = exports.read_text().split()
    yield from (f'{name} is exported and in no page' for name in exported if f'c.{name}' not in anchors)
    if not pages or not names or not exported:
        yield 'there is nothing to check'


def main():
    site, doxygen, exports = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    found = list(faults(site, doxygen, exports))
    print('\n'.join(found), end='\n' if found else '')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
