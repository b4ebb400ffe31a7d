# SPDX-License-Identifier: MIT
"""Makes the report from its templates, its data and its figures: two pages that need no other file, nor each other.

usage: page.py [--quick] --into FOLDER --cmark PROGRAM FILE.tsv... FILE.svg...

index.md.in and evidence.md.in are Markdown with Jinja2 expressions. An expression takes its numbers from the data files, by
the names of their columns, and a figure from its picture and the comment that opens its script, a template, too. Figures
are numbered through both pages, and each stands in one of them. Whatever is not there - a file, a row, a column, a name -
is an error that names it; so is a claim that the template has checked and that does not hold. The data files are copied to
FOLDER/data. Where FOLDER/../live/index.html exists, templates see that by the name live.
"""

import argparse
import html
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import jinja2

HERE = pathlib.Path(__file__).resolve().parent
PAGES = {"index": "Spring simulation: methods, steps and accuracy", "evidence": "Spring simulation: evidence"}  # and their titles


class DataError(Exception):
    """Something the template asks for is not in the data."""


class Row:
    """A row of a table. Its cells are attributes, row.error_m, numbers where they can be."""

    def __init__(self, table, cells):
        self._table = table
        self._cells = dict(zip(table.columns, cells))

    def raw(self, column):
        """A cell as it is written in the file."""
        if column not in self._cells:
            raise DataError(f'{self._table.name}: no column "{column}"')
        return self._cells[column]

    def __getattr__(self, column):
        if column.startswith("__"):  # Jinja asks what kind of object this is
            raise AttributeError(column)
        return number(self.raw(column))


class Table:
    """A data file: comment lines, a header line, rows."""

    def __init__(self, path):
        self.name = path.name
        lines = path.read_text(encoding="utf-8").splitlines()
        self.comments = [line.lstrip("# ") for line in lines if line.startswith("#")]
        content = [line.split("\t") for line in lines if line and not line.startswith("#")]
        if not content:
            raise DataError(f"{self.name}: no header line")
        self.columns = content[0]
        self.rows = [Row(self, cells) for cells in content[1:]]

    def row(self, **wanted):
        """The one row in which each of the given columns has the given value."""
        found = [r for r in self.rows if all(getattr(r, column) == value for column, value in wanted.items())]
        if len(found) != 1:
            what = ", ".join(f"{column} = {value}" for column, value in wanted.items())
            raise DataError(f"{self.name}: {len(found)} rows with {what or 'anything'}, one was expected")
        return found[0]

    @property
    def last(self):
        """The last row: of a run, its final state."""
        if not self.rows:
            raise DataError(f"{self.name}: no rows")
        return self.rows[-1]

    def comment(self, key):
        """The text of the comment line "# key: text"."""
        for line in self.comments:
            if line.startswith(key + ":"):
                return line[len(key) + 1 :].strip()
        raise DataError(f'{self.name}: no comment "{key}:"')

    def setting(self, option):
        """What the command that made the file gave for --option, the last time where it was given twice."""
        words = shlex.split(self.comment("command"))
        for word, value in zip(reversed(words[:-1]), reversed(words[1:])):
            if word == "--" + option:
                return number(value)
        raise DataError(f"{self.name}: made without --{option}")


def number(text):
    """A cell as the number it is, or else as the text it is."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def scientific(x, digits):
    """2.88367e-2: the digits after the point, and an exponent without padding."""
    mantissa, exponent = f"{x:.{digits}e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def count(n):
    """34 766, with narrow spaces that do not break."""
    return f"{n:,}".replace(",", "\u202f")


def check(condition, claim):
    """Nothing, if what the text is about to claim is so."""
    if not condition:
        raise DataError(f"the data do not bear out: {claim}")
    return ""


def stem_of(path):
    """The name by which the template calls a file; a quick report's own files are marked in their names."""
    return path.stem.removeprefix("quick-")


def caption_of(script):
    """The comment that opens a figure's script, without the licence line: a template."""
    path = HERE / f"{script}.gp"
    if not path.exists():
        path = path.with_suffix(".py")
    lines = path.read_text(encoding="utf-8").splitlines()[1:]
    comment = []
    for line in lines:
        if not line.startswith("# "):
            break
        comment.append(line[2:])
    if not comment:
        raise DataError(f"{path.name}: no caption in its first comment")
    return " ".join(comment)


def palette():
    """The colours of the figures by name, from style.gp: {"method-1": (213, 94, 0), "exact": (0, 0, 0), ...}."""
    lines = re.findall(r'^set linetype (\w+) +linecolor rgb "#(\w{6})"', (HERE / "style.gp").read_text(), re.MULTILINE)
    return {"method-" * name.isdigit() + name: tuple(bytes.fromhex(colour)) for name, colour in lines}


def drawing(path, label):
    """A drawing, inside the page: its names its own, its colours those of the page, its size the column's.

    An animation plays by its own style; what pauses it stands before it.
    """
    stem = stem_of(path)
    svg = path.read_text(encoding="utf-8")
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<title>.*?</title>|<desc>.*?</desc>", "", svg, flags=re.DOTALL)
    svg = re.sub(r"""(\bid=["']|href=["']#)""", rf"\1{stem}-", svg)  # a href without # holds an image
    svg = svg.replace("url(#", f"url(#{stem}-")
    svg = re.sub(r"""(["'])black\1""", r"\1currentColor\1", svg)
    for name, rgb in palette().items():
        svg = re.sub(r"rgb\( *%d, *%d, *%d\)" % rgb, f"var(--{name})", svg)
    svg = re.sub(r'\n width="\d+" height="\d+"', f'\n role="img" aria-label="{html.escape(label)}"', svg, count=1)
    if 'class="film ' in svg:
        pause = f"{stem}-pause"
        svg = f'<input class="pause" type="checkbox" id="{pause}"><label class="pause" for="{pause}">Pause</label>\n{svg}'
    return svg


def to_html(cmark, markdown):
    """What the Markdown converter makes of the text; headings can be linked to, and wide tables scrolled."""
    command = [cmark, "--unsafe", "--smart", "--extension", "table"]
    text = subprocess.run(command, input=markdown, capture_output=True, text=True, check=True, encoding="utf-8").stdout
    headings = []

    def with_id(match):
        title = match[1]
        words = re.findall(r"[a-z0-9]+", re.sub("<.*?>", "", title).lower())
        name = "-".join(["section", *words])  # figures have names, too
        headings.append(f'<li><a href="#{name}">{title}</a></li>')
        return f'<h2 id="{name}">{title}</h2>'

    text = re.sub(r"<h2>(.*?)</h2>", with_id, text)
    text = text.replace("<!-- contents -->", '<nav aria-label="Contents">\n<ol>\n' + "\n".join(headings) + "\n</ol>\n</nav>")
    return text.replace("<table>", '<div class="table"><table>').replace("</table>", "</table></div>")


class Figures:
    """The pictures, the pages they are on, and their numbers."""

    def __init__(self, files):
        self.files = {stem_of(path): path for path in files}
        self.places = {}  # by stem: page, number, picture

    def place(self, page, stem, title, caption):
        """A figure, with a mark where its picture goes when the Markdown has been converted."""
        if stem in self.places:
            raise DataError(f'picture "{stem}" is there twice')
        title = html.escape(title, quote=False).replace("'", "’")  # as the Markdown converter does in a text
        self.places[stem] = (page, len(self.places) + 1, drawing(self.files[stem], f"{title}. {caption}"))
        return (
            f'<figure id="{stem}">\n<p class="title">Figure {len(self.places)}. {title}</p>\n'
            f"<!-- picture {stem} -->\n<figcaption>\n\n{caption}\n\n</figcaption>\n</figure>\n"
        )

    def fill(self, page, text):
        """The text of a page with pictures where their marks are, and numbers where others are referred to."""
        for stem in self.files:
            if stem not in self.places:
                raise DataError(f'picture "{stem}" is nowhere in the report')

        def reference(match):
            if match[1] not in self.places:
                raise DataError(f'no picture "{match[1]}" to refer to')
            where, place, _ = self.places[match[1]]
            return f'<a href="{"" if where == page else where + ".html"}#{match[1]}">Figure {place}</a>'

        text = re.sub(r'<a href="figure:([^"]*)"></a>', reference, text)
        return re.sub(r"<!-- picture (\S+) -->", lambda match: self.places[match[1]][2], text)


def make(arguments):
    """Writes the pages and copies their data."""
    tables = {stem_of(path): Table(path) for path in arguments.files if path.suffix == ".tsv"}
    figures = Figures(path for path in arguments.files if path.suffix == ".svg")

    def data(stem):
        if stem not in tables:
            raise DataError(f'no data file "{stem}"')
        return tables[stem]

    def label(method):
        return data("methods").row(method=method).label

    def steppers(shape):
        """The rows of the methods for springs or scenes, in the order of the table, without the exact solution."""
        return [row for row in data("methods").rows if getattr(row, shape) and row.order > 0]

    def step(stem):
        """The step of the run that made a data file."""
        return f"{1000 * data(stem).setting('dt'):.3g} ms"

    @jinja2.pass_context
    def figure(context, stem, title, script=None, method=""):
        if stem not in figures.files:
            raise DataError(f'no picture "{stem}"')
        caption = jinja.from_string(caption_of(script or stem)).render(method=method[:1].upper() + method[1:])
        return figures.place(context["page"], stem, title, caption)

    jinja = jinja2.Environment(
        loader=jinja2.FileSystemLoader(HERE), undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    jinja.filters.update(scientific=scientific, count=count)
    jinja.globals.update(check=check, data=data, figure=figure, label=label, step=step, steppers=steppers)
    jinja.globals.update(reference="[](figure:{})".format, quick=arguments.quick, stems=sorted(tables))
    jinja.globals.update(live=(arguments.into.parent / "live/index.html").exists())

    # All figures have their numbers before any is referred to.
    bodies = {page: to_html(arguments.cmark, jinja.get_template(f"{page}.md.in").render(page=page)) for page in PAGES}
    colours = {name: "#%02X%02X%02X" % rgb for name, rgb in palette().items()}
    frame = jinja.get_template("page.html.in")
    pages = {
        page: frame.render(title=PAGES[page], body=figures.fill(page, body), colours=colours)
        for page, body in bodies.items()
    }

    copies = arguments.into / "data"
    shutil.rmtree(copies, ignore_errors=True)
    copies.mkdir(parents=True)
    for path in arguments.files:
        if path.suffix == ".tsv":
            shutil.copyfile(path, copies / f"{stem_of(path)}.tsv")
    for page, text in pages.items():
        (arguments.into / f"{page}.html").write_text(text, encoding="utf-8")


def main():
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="mark the pages as those of a quick study")
    parser.add_argument("--into", type=pathlib.Path, required=True, help="folder of the pages and data/")
    parser.add_argument("--cmark", required=True, help="the program cmark-gfm")
    parser.add_argument("files", type=pathlib.Path, nargs="+", help="data files (.tsv) and pictures (.svg)")
    arguments = parser.parse_args()
    try:
        make(arguments)
    except jinja2.TemplateSyntaxError as error:
        sys.exit(f"page.py: {error.name or 'a caption'}, line {error.lineno}: {error}")
    except (DataError, jinja2.TemplateError, OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"page.py: {error}")


if __name__ == "__main__":
    main()
