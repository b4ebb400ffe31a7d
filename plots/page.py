# SPDX-License-Identifier: MIT
"""Makes the report from its template, its data and its figures: one page that needs no other file.

usage: page.py [--quick] --into FOLDER --cmark PROGRAM [--if-there FILE.tsv] FILE.tsv... FILE.svg... FILE.gif...

report.md.in is Markdown with Jinja2 expressions. An expression takes its numbers from the data files, by the names of
their columns, and a figure from its picture and the comment that opens its script. Whatever is not there - a file, a row,
a column, a name - is an error that names it; so is a claim that the template has checked and that does not hold. The data
files are copied to FOLDER/data.
"""

import argparse
import base64
import html
import pathlib
import re
import shutil
import struct
import subprocess
import sys

import jinja2

HERE = pathlib.Path(__file__).resolve().parent


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


def caption_of(script, method):
    """The comment that opens a figure's script, without the licence line, about the method where it is about one."""
    lines = (HERE / f"{script}.gp").read_text(encoding="utf-8").splitlines()[1:]
    comment = []
    for line in lines:
        if not line.startswith("# "):
            break
        comment.append(line[2:])
    if not comment:
        raise DataError(f"{script}.gp: no caption in its first comment")
    return " ".join(comment).replace("{method}", method[:1].upper() + method[1:])


def palette():
    """The colours of the figures by name, from style.gp: {"method-1": (213, 94, 0), "exact": (0, 0, 0), ...}."""
    lines = re.findall(r'^set linetype (\w+) +linecolor rgb "#(\w{6})"', (HERE / "style.gp").read_text(), re.MULTILINE)
    return {"method-" * name.isdigit() + name: tuple(bytes.fromhex(colour)) for name, colour in lines}


def inline(path, label):
    """What shows a picture in the page, without another file."""
    return (animation if path.suffix == ".gif" else drawing)(path, html.escape(label))


def animation(path, label):
    """An animation as it is, with its size, which a GIF has behind six bytes, so that the text need not move for it."""
    content = path.read_bytes()
    if content[:6] != b"GIF89a":
        raise DataError(f"{path.name}: not an animation")
    width, height = struct.unpack_from("<HH", content, 6)
    source = "data:image/gif;base64," + base64.b64encode(content).decode()
    return f'<img src="{source}" width="{width}" height="{height}" alt="{label}">'


def drawing(path, label):
    """A drawing: its names its own, its colours those of the page, its size the column's."""
    stem = stem_of(path)
    svg = path.read_text(encoding="utf-8")
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<title>.*?</title>|<desc>.*?</desc>", "", svg, flags=re.DOTALL)
    svg = re.sub(r"""(\bid=["']|href=["']#)""", rf"\1{stem}-", svg)  # a href without # holds an image
    svg = svg.replace("url(#", f"url(#{stem}-")
    svg = re.sub(r"""(["'])black\1""", r"\1currentColor\1", svg)
    for name, rgb in palette().items():
        svg = re.sub(r"rgb\( *%d, *%d, *%d\)" % rgb, f"var(--{name})", svg)
    return re.sub(r'\n width="\d+" height="\d+"', f'\n role="img" aria-label="{label}"', svg, count=1)


def to_html(cmark, markdown):
    """What the Markdown converter makes of the text."""
    command = [cmark, "--unsafe", "--smart", "--extension", "table"]
    return subprocess.run(command, input=markdown, capture_output=True, text=True, check=True, encoding="utf-8").stdout


def make(arguments):
    """Writes the page and copies its data."""
    tables = {stem_of(path): Table(path) for path in arguments.files if path.suffix == ".tsv"}
    pictures = {stem_of(path): path for path in arguments.files if path.suffix in (".svg", ".gif")}
    used = {}

    def data(stem):
        if stem not in tables:
            raise DataError(f'no data file "{stem}"')
        return tables[stem]

    def label(method):
        return data("methods").row(method=method).label

    def steppers(shape):
        """The rows of the methods for springs or scenes, in the order of the table, without the exact solution."""
        return [row for row in data("methods").rows if getattr(row, shape) and row.order > 0]

    def figure(stem, script=None, method=""):
        if stem not in pictures:
            raise DataError(f'no picture "{stem}"')
        caption = caption_of(script or stem, method)
        used[f"<!-- picture {stem} -->"] = inline(pictures[stem], caption)
        return f'<figure id="{stem}">\n<!-- picture {stem} -->\n<figcaption>\n\n{caption}\n\n</figcaption>\n</figure>\n'

    jinja = jinja2.Environment(
        loader=jinja2.FileSystemLoader(HERE), undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    jinja.filters.update(scientific=scientific, count=count)
    jinja.globals.update(check=check, data=data, figure=figure, label=label, steppers=steppers)
    jinja.globals.update(quick=arguments.quick, stems=sorted(tables))

    body = to_html(arguments.cmark, jinja.get_template("report.md.in").render())
    for stem in pictures:
        if f"<!-- picture {stem} -->" not in used:
            raise DataError(f'picture "{stem}" is nowhere in the report')
    body = body.replace("<table>", '<div class="table"><table>').replace("</table>", "</table></div>")
    for mark, svg in used.items():
        body = body.replace(mark, svg)
    colours = {name: "#%02X%02X%02X" % rgb for name, rgb in palette().items()}
    page = jinja.get_template("page.html.in").render(body=body, colours=colours)

    copies = arguments.into / "data"
    shutil.rmtree(copies, ignore_errors=True)
    copies.mkdir(parents=True)
    for path in arguments.files:
        if path.suffix == ".tsv":
            shutil.copyfile(path, copies / f"{stem_of(path)}.tsv")
    (arguments.into / "index.html").write_text(page, encoding="utf-8")


def main():
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="mark the page as that of a quick study")
    parser.add_argument("--into", type=pathlib.Path, required=True, help="folder of index.html and data/")
    parser.add_argument("--cmark", required=True, help="the program cmark-gfm")
    parser.add_argument("--if-there", type=pathlib.Path, help="a data file that the template can do without")
    parser.add_argument("files", type=pathlib.Path, nargs="+", help="data files (.tsv), pictures (.svg) and animations (.gif)")
    arguments = parser.parse_args()
    if arguments.if_there and arguments.if_there.exists():
        arguments.files.append(arguments.if_there)
    try:
        make(arguments)
    except (DataError, jinja2.TemplateError, OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"page.py: {error}")


if __name__ == "__main__":
    main()
