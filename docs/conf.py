# SPDX-License-Identifier: MIT
"""How Sphinx makes the site of these pages; tools/docs calls it."""

import os
import pathlib
import re

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms import SphinxTransform

root = pathlib.Path(__file__).resolve().parent.parent

project = 'springstep'
release = re.search(r'SPRING_VERSION "(.*)"', (root / 'include/springstep/version.h').read_text())[1]
copyright = 'the authors of springstep'
html_title = f'springstep {release}'

extensions = ['breathe', 'myst_parser']
root_doc = 'index'
myst_heading_anchors = 3  # the anchors that a code host makes, too
nitpicky = True
c_id_attributes = ['SPRING_API']
nitpick_ignore = [('c:identifier', name) for name in ('size_t', 'uint8_t', 'uint32_t', 'uint64_t')]

breathe_projects = {'springstep': str(root / 'build/docs-xml/xml')}
breathe_default_project = 'springstep'
breathe_domain_by_extension = {'h': 'c'}
breathe_show_define_initializer = True

html_theme = 'furo'
pygments_style = 'default'  # all colours have a contrast of at least 4.5, unlike those of the theme in Debian
html_static_path = ['style.css']
html_css_files = ['style.css']
html_copy_source = False
html_show_sphinx = False
html_theme_options = {
    # Furo's own colours, which its style sheet in Debian 12 (2022.12.07+dfsg-1) has lost: pages stayed light in the dark.
    'dark_css_variables': {
        'color-problematic': '#ee5151',
        'color-foreground-primary': '#ffffffcc',
        'color-foreground-secondary': '#9ca0a5',
        'color-foreground-muted': '#81868d',
        'color-foreground-border': '#666666',
        'color-background-primary': '#131416',
        'color-background-secondary': '#1a1c1e',
        'color-background-hover': '#1e2124',
        'color-background-hover--transparent': '#1e212400',
        'color-background-border': '#303335',
        'color-background-item': '#444',
        'color-brand-primary': '#2b8cee',
        'color-brand-content': '#368ce2',
        'color-highlighted-background': '#083563',
        'color-highlight-on-target': '#333300',
    },
}


class Tidy(SphinxTransform):
    """What Breathe cannot be told: structures before the functions that take them, and without headings."""

    default_priority = 840  # before the index is made, at 850

    def apply(self):
        for node in list(self.document.findall(addnodes.desc)):
            siblings = node.parent.children
            if node['objtype'] == 'struct':
                for needless in [c for c in node[1] if 'include' in c.astext()[:8]] + list(node.findall(nodes.rubric)):
                    needless.parent.remove(needless)
                others = (s for s in siblings if isinstance(s, (nodes.container, addnodes.index)))
                first = siblings.index(next(others))
                if first < siblings.index(node):
                    siblings.remove(node)
                    siblings.insert(first, node)


class KeepNumbers(SphinxTransform):
    """Marks numbers such as 1.4e-2 in tables, because browsers may break a line after the minus sign."""

    default_priority = 840

    def apply(self):
        for cell in self.document.findall(nodes.entry):
            for text in list(cell.findall(nodes.Text)):
                others_and_numbers = re.split(r'(\d[\d.]*e-\d+)', text)
                if len(others_and_numbers) > 1:
                    text.parent.replace(text, [
                        nodes.inline('', part, classes=['number']) if i % 2 else nodes.Text(part)
                        for i, part in enumerate(others_and_numbers)
                    ])


def show_examples(app, name, source):
    """The page of the examples is that of their folder, its links as seen from here."""
    if name == 'examples':
        text = (root / 'examples/README.md').read_text()
        seen_from_here = lambda link: '](' + os.path.relpath(root / 'examples' / link[1], root / 'docs')
        source[0] = re.sub(r'\]\(([^):#]+)(?=[)#])', seen_from_here, text)


def inline(file, statement, folder):
    """Replaces each statement in a file that imports another file of a folder by the text of that file."""
    file.write_text(re.sub(statement, lambda match: (folder / match[1]).read_text(), file.read_text()))


def complete_theme(app, error):
    """Completes Furo's files in Debian. Its style sheet imports normalize.css from a folder beside the site. Its script
    imports a script that defines a global variable of the imported name. With the text of that script instead of the
    import, it is a classic script."""
    if error is None:
        static = pathlib.Path(app.outdir) / '_static'
        inline(static / 'styles/furo.css', r'@import url\(/(javascript/[^)]*)\);', pathlib.Path('/usr/share'))
        inline(static / 'scripts/furo.js', r'(?m)^import (?:\* as )?Gumshoe from "\./([^"]+)";$', static / 'scripts')


def include_classic_scripts(app, page, template, context, doctree):
    """Furo's script is a module in Debian 13. Browsers do not load modules from a disk."""
    for script in context['script_files']:
        script.attributes.pop('type', None)


def setup(app):
    app.add_transform(Tidy)
    app.add_transform(KeepNumbers)
    app.connect('source-read', show_examples)
    app.connect('html-page-context', include_classic_scripts)
    app.connect('build-finished', complete_theme)
