// Turns Markdown into HTML for the documents of the site.

import MarkdownIt from 'markdown-it';

const markdown = new MarkdownIt();
const { escapeHtml } = markdown.utils;

/** Code, in a box that scrolls, also by keyboard. */
export const codeBox = (code) => `<pre tabindex="0"><code>${escapeHtml(code)}</code></pre>\n`;

export { escapeHtml };

markdown.renderer.rules.fence = (tokens, i) => codeBox(tokens[i].content);
markdown.renderer.rules.table_open = (tokens, i) =>
  `<div class="table" tabindex="0" role="region" aria-label="${tokens[i].meta}"><table>\n`;
markdown.renderer.rules.table_close = () => '</table></div>\n';

/** The anchor of a heading, as GitHub makes it. */
export const anchorOf = (heading) =>
  heading
    .toLowerCase()
    .replace(/[^\w\- ]/g, '')
    .replaceAll(' ', '-');

/** The words of inline tokens, without their marks. */
const wordsOf = (tokens) =>
  tokens
    .filter(({ type }) => type === 'text' || type === 'code_inline')
    .map(({ content }) => content)
    .join('');

/** The targets of all links and pictures of a document. */
export function targetsOf(text) {
  return markdown.parse(text, {}).flatMap(({ children }) =>
    (children ?? []).flatMap(({ type, attrs }) => {
      if (type !== 'link_open' && type !== 'image') return [];
      return attrs.filter(([name]) => name === 'href' || name === 'src').map(([, target]) => decodeURI(target));
    }),
  );
}

/**
 * The title of a document, without marks, and its text as HTML. `addressOf` gives the address for a target; for
 * `undefined`, the link becomes plain text that names the target.
 */
export function render(text, addressOf) {
  const tokens = markdown.parse(text, {});
  let title = '';
  let tables = 0;
  const anchors = new Map();
  for (const [i, token] of tokens.entries()) {
    const words = wordsOf(tokens[i + 1]?.children ?? []);
    if (token.type === 'heading_open') {
      const anchor = anchorOf(words);
      const count = anchors.get(anchor) ?? 0;
      anchors.set(anchor, count + 1);
      token.attrSet('id', count === 0 ? anchor : `${anchor}-${count}`);
      if (token.tag === 'h1') title ||= words;
    }
    // Each table is a region, whose name has to differ from those of the others.
    if (token.type === 'table_open') token.meta = `Table ${++tables}`;
    // The page's policy forbids styles that are not in files.
    const [, side] = token.attrGet('style')?.match(/^text-align:(\w+)$/) ?? [];
    if (side) token.attrs = [['class', side]];
    // A header without words is no header.
    if (token.type === 'th_open' && words === '') token.tag = tokens[i + 2].tag = 'td';
    if (token.children) token.children = withAddresses(token.children, addressOf);
  }
  return { title, html: markdown.renderer.render(tokens, markdown.options, {}) };
}

function withAddresses(children, addressOf) {
  const all = [];
  let plain;
  for (const token of children) {
    const name = { link_open: 'href', image: 'src' }[token.type];
    if (name) {
      const target = decodeURI(token.attrGet(name));
      const address = addressOf(target);
      if (address !== undefined) token.attrSet(name, address);
      else {
        token.hidden = true;
        plain = target;
      }
    }
    if (token.type === 'link_close' && plain !== undefined) {
      token.hidden = true;
      const target = new token.constructor('text', '', 0);
      target.content = ` (${plain.replace(/^https?:\/\//, '')})`;
      all.push(target);
      plain = undefined;
    }
    all.push(token);
  }
  return all;
}
