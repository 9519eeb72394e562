"""Markdown as the repository's host shows it: headings with the same anchors, tables, highlighted code, links of the site."""

import re
from html import escape

from markdown_it import MarkdownIt
from pages import Heading
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_by_name
from pygments.util import ClassNotFound

# Lexers of names that differ.
LEXERS = {"sh": "bash", "": "text"}


def coloured(code, language):
    """Code as HTML with the classes of site.css."""
    try:
        lexer = get_lexer_by_name(LEXERS.get(language, language), stripnl=False)
    except ClassNotFound:
        return escape(code, quote=False)
    return highlight(code, lexer, HtmlFormatter(nowrap=True))


def anchor_of(title, taken):
    """The anchor of a heading: lower case, no punctuation, hyphens for blanks, a number where it is taken."""
    slug = re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-")
    count = taken.get(slug, 0)
    taken[slug] = count + 1
    return f"{slug}-{count}" if count else slug


def plain(token):
    """The words of an inline token, without marks."""
    words = (
        child.content if child.type in ("text", "code_inline") else " " if "break" in child.type else ""
        for child in token.children
    )
    return "".join(words)


def breakable(code):
    """Code inside of a line as HTML: long names break at their joints."""
    text = escape(code, quote=False)
    return re.sub(r"(::?|_|/|,|=)(?=\w)|(?<=[a-z])(?=[A-Z])", r"\1<wbr>", text) if len(code) > 14 else text


def parser():
    made = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
    made.add_render_rule(
        "fence", lambda self, tokens, index, options, env: block(tokens[index].content, tokens[index].info.strip())
    )
    made.add_render_rule("code_inline", lambda self, tokens, index, *_: f"<code>{breakable(tokens[index].content)}</code>")
    for name in ("html_block", "html_inline"):
        made.add_render_rule(
            name,
            lambda self, tokens, index, *_: tokens[index].content if tokens[index].meta.get("ours") else own(tokens[index]),
        )
    made.add_render_rule("code_block", lambda self, tokens, index, options, env: block(tokens[index].content, ""))
    made.add_render_rule("table_open", lambda *_: '<div class="scroll" tabindex="0" role="region" aria-label="Table"><table>\n')
    made.add_render_rule("table_close", lambda *_: "</table></div>\n")
    return made


def own(token):
    """HTML of the text itself: comments are not shown, anything else is shown as it is written."""
    return escape(re.sub(r"<!--.*?-->", "", token.content, flags=re.S).rstrip(), quote=False)


def block(code, language):
    name = f' data-language="{escape(language)}"' if language not in ("", "text") else ""
    return f'<div class="code"{name}><pre tabindex="0"><code>{coloured(code, language)}</code></pre></div>\n'


def render(page, text, links):
    """Fills a page from its Markdown; `links(href, line, is_image)` gives where a link of the text leads on the site."""
    made = parser()
    tokens = made.parse(text)
    lines, taken = text.splitlines(), {}
    page.headings, page.sections = [], []
    anchor, heading, words = "", "", []
    for index, token in enumerate(tokens):
        if token.type == "heading_open":
            page.sections.append((anchor, heading, " ".join(words)))
            heading = plain(tokens[index + 1])
            anchor, words = anchor_of(heading, taken), []
            token.attrSet("id", anchor)
            page.headings.append(Heading(int(token.tag[1]), anchor, heading))
            if token.tag == "h1" and not page.title:
                page.title = heading
                anchor = ""
        elif token.type == "inline":
            if tokens[index - 1].type != "heading_open":
                words.append(plain(token))
            relink(token, lines, links)
        elif token.type in ("fence", "code_block"):
            words.append(token.content)
        elif token.type == "heading_close" and token.tag != "h1":
            mark = f'<a class="anchor" href="#{escape(anchor)}" aria-label="Link to this section">#</a>'
            token.meta["ours"] = True
            token.type, token.content, token.tag = "html_block", mark + f"</{token.tag}>\n", ""
    page.sections.append((anchor, heading, " ".join(words)))
    page.sections = [(anchor, heading, " ".join(words.split())) for anchor, heading, words in page.sections if heading or words]
    page.body = made.renderer.render(tokens, made.options, {})


def relink(token, lines, links):
    """Links and pictures of an inline token, with the line of the file that they are in."""
    for at, child in enumerate(token.children):
        name = {"link_open": "href", "image": "src"}.get(child.type)
        if not name:
            continue
        href = child.attrGet(name)
        first, last = token.map
        line = next((row for row in range(first, last) if f"]({href}" in lines[row]), first) + 1
        text = token.children[at + 1] if child.type == "link_open" else None
        if text and text.content.endswith(".md") and href.partition("#")[0].endswith(text.content):
            # A file's name as the words of a link: a site has pages.
            stem = text.content.removesuffix("/README.md").rpartition("/")[2].removesuffix(".md")
            text.content = stem.capitalize() if stem.isupper() else stem
        child.attrSet(name, links(href, line, child.type == "image"))
        if "://" in href:
            child.attrSet("rel", "external")
