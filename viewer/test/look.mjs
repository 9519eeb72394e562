// What a reader would see of a page or a figure, said in sentences where it is wrong.
// `look` is put into every page that is opened: it may use nothing from outside of itself.

export function look() {
  const shown = element => element.checkVisibility({ visibilityProperty: true, opacityProperty: true, contentVisibilityAuto: true });
  const start = text => { const t = text.trim().replace(/\s+/g, ' '); return `“${t.length > 48 ? `${t.slice(0, 47)}…` : t}”`; };
  const whole = value => Math.round(value);
  const said = list => [...new Set(list)];

  /** Text nodes that are seen, each with its element. */
  function texts(root = document.documentElement) {
    const found = [], walk = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      const node = walk.currentNode, element = node.parentElement;
      if (node.textContent.trim() && !element.closest('script, noscript, style, head, title') && shown(element)) found.push({ node, element, words: node.textContent });
    }
    return found;
  }

  /** Where a name in a sentence leads: the element as a selector would have it, with its place in the page. */
  function name(element) {
    const own = element.id ? `#${element.id}` : element.tagName.toLowerCase() + (element.getAttribute('class') ? `.${element.getAttribute('class').trim().split(/\s+/).join('.')}` : '');
    const section = element.closest('section[id], article[id], header, footer, nav, aside');
    return section && section !== element ? `${section.id ? `#${section.id}` : section.tagName.toLowerCase()} ${own}` : own;
  }

  // Colours: [red, green, blue, how much covers], as WCAG 2 compares them.
  const canvas = document.createElementNS('http://www.w3.org/1999/xhtml', 'canvas').getContext('2d', { willReadFrequently: true });
  const known = new Map();
  function colour(css) {
    if (!known.has(css)) {
      canvas.clearRect(0, 0, 1, 1);
      canvas.fillStyle = css;
      canvas.fillRect(0, 0, 1, 1);
      const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
      known.set(css, [r, g, b, a / 255]);
    }
    return known.get(css);
  }
  const over = ([r, g, b, a], [R, G, B]) => [r * a + R * (1 - a), g * a + G * (1 - a), b * a + B * (1 - a), 1];
  const channel = c => { c /= 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
  const light = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
  const ratio = (a, b) => { const [low, high] = [light(a), light(b)].sort((x, y) => x - y); return (high + 0.05) / (low + 0.05); };
  const hex = c => `#${c.slice(0, 3).map(x => whole(x).toString(16).padStart(2, '0')).join('')}`;
  const paper = () => (matchMedia('(prefers-color-scheme: dark)').matches && getComputedStyle(document.documentElement).colorScheme.includes('dark') ? [18, 18, 18, 1] : [255, 255, 255, 1]);

  /** What lies behind an element of HTML. */
  function behind(element) {
    const layers = [];
    for (let e = element; e; e = e.parentElement) {
      const c = colour(getComputedStyle(e).backgroundColor);
      if (c[3] > 0) layers.push(c);
      if (c[3] === 1) break;
    }
    return layers.reduceRight((below, layer) => over(layer, below), paper());
  }

  const fill = element => { const style = getComputedStyle(element), c = style.fill === 'none' ? [0, 0, 0, 0] : colour(style.fill); return [c[0], c[1], c[2], c[3] * Number(style.fillOpacity) * Number(style.opacity)]; };

  /** Shapes of a figure that cover something, in the order in which they are painted. */
  function shapes(svg) {
    return [...svg.querySelectorAll('rect, path, circle, ellipse, polygon')].filter(shape => !shape.closest('defs, clipPath, mask, marker, pattern, symbol') && fill(shape)[3] > 0)
      .map(shape => ({ shape, fill: fill(shape), box: shape.getBoundingClientRect(), back: shape.getScreenCTM().inverse() }));
  }

  /** Colours behind a text of a figure: at its corners, a little inside, and in its middle. */
  function under(text, svg, painted) {
    const { left, right, top, bottom, width, height } = text.getBoundingClientRect(), x = width / 10, y = height / 4;
    const page = svg.parentElement ? behind(svg.parentElement) : paper();
    return [[left + x, top + y], [right - x, top + y], [left + x, bottom - y], [right - x, bottom - y], [left + width / 2, top + height / 2]].map(([px, py]) => {
      const covering = painted.filter(({ shape, box, back }) => shape.compareDocumentPosition(text) & Node.DOCUMENT_POSITION_FOLLOWING
        && px >= box.left && px <= box.right && py >= box.top && py <= box.bottom && shape.isPointInFill(new DOMPoint(px, py).matrixTransform(back)));
      return covering.reduce((below, layer) => over(layer.fill, below), page);
    });
  }

  /** Texts that are too faint to be read. */
  function faint() {
    const painted = new Map(), found = [];
    for (const { element, words } of texts()) {
      const style = getComputedStyle(element), size = parseFloat(style.fontSize), bold = Number(style.fontWeight) >= 700, svg = element.closest('svg');
      let ink, papers;
      if (svg) {
        if (!painted.has(svg)) painted.set(svg, shapes(svg));
        ink = fill(element);
        papers = under(element.closest('text') ?? element, svg, painted.get(svg));
      } else {
        ink = colour(style.color);
        papers = [behind(element)];
      }
      let opacity = 1;
      for (let e = svg ? svg.parentElement : element; e; e = e.parentElement) opacity *= Number(getComputedStyle(e).opacity);
      const least = size >= 24 || (bold && size >= 18.66) ? 3 : 4.5;
      for (const back of papers) {
        const seen = over([ink[0], ink[1], ink[2], ink[3] * opacity], back), found_ratio = ratio(seen, back);
        if (found_ratio < least - 0.005) found.push(`${start(words)} (${name(element)}) has a contrast of ${found_ratio.toFixed(2)}, ${hex(seen)} on ${hex(back)}, and needs ${least}`);
      }
    }
    return said(found);
  }

  /** The result in a sentence, right after the heading, with a number in it; one a run where runs stand side by side. */
  function unsaid() {
    const headings = [...document.querySelectorAll('h1')].filter(shown);
    if (!headings.length) return ['there is no h1'];
    return headings.flatMap(h1 => {
      const after = h1.closest('.who') ?? h1, verdict = after.nextElementSibling, of = start(h1.textContent);
      if (!verdict?.matches('.verdict')) return [`after the h1 ${of} comes ${verdict ? name(verdict) : 'nothing'}, no .verdict`];
      if (!shown(verdict)) return [`the verdict of ${of} is not seen`];
      return /\d/.test(verdict.textContent) ? [] : [`the verdict of ${of} has no number: ${start(verdict.textContent)}`];
    });
  }

  /** Whether an element scrolls by itself or lies in one that does. */
  const scrolls = element => { for (let e = element; e && e !== document.body && e !== document.documentElement; e = e.parentElement) if (getComputedStyle(e).overflowX !== 'visible') return true; return false; };

  /** A page that scrolls sideways, and what sticks out of it. */
  function sideways() {
    const root = document.scrollingElement, found = [];
    for (const box of [root, document.body]) if (box.scrollWidth > box.clientWidth + 1) found.push(`${name(box)} is ${box.scrollWidth} px wide in a place of ${box.clientWidth} px`);
    for (const element of document.body.querySelectorAll('*')) {
      if (element.closest('svg') && element.tagName !== 'svg') continue;
      const { right, width } = element.getBoundingClientRect();
      if (width && right > root.clientWidth + 1 && shown(element) && !scrolls(element)) found.push(`${name(element)} ${start(element.textContent)} ends at ${whole(right)} px of ${root.clientWidth} px`);
    }
    return said(found);
  }

  /** On paper nothing scrolls: what is wider than its place is cut. */
  function cut() {
    const width = document.documentElement.clientWidth, found = [];
    for (const element of document.body.querySelectorAll('*')) {
      if ((element.closest('svg') && element.tagName !== 'svg') || !shown(element)) continue;
      const { right, width: own } = element.getBoundingClientRect(), style = getComputedStyle(element);
      if (own && right > width + 1) found.push(`${name(element)} ${start(element.textContent)} ends at ${whole(right)} px of a page of ${width} px`);
      if (style.overflowX !== 'visible' && element.scrollWidth > element.clientWidth + 1 && element.clientWidth) found.push(`${name(element)} shows ${element.clientWidth} px of ${element.scrollWidth} px`);
    }
    return said(found);
  }

  /** Details whose contents are not seen. */
  const folded = () => [...document.querySelectorAll('details')].filter(details => ![...details.children].some(child => child.tagName !== 'SUMMARY' && shown(child) && child.getBoundingClientRect().height > 1))
    .map(details => `the contents of ${start(details.querySelector('summary').textContent)} are not seen`);

  const openAll = () => document.querySelectorAll('details').forEach(details => { details.open = true; });

  /** Headings and heads of tables with nothing in them. */
  const nameless = () => [...document.querySelectorAll('h1, h2, h3, h4, summary, figcaption, title')].filter(heading => !heading.textContent.trim()).map(heading => `${name(heading)} is empty`);

  /** What a program says and a reader should not. */
  function leaks() {
    const found = [], wrong = /`|\b(?:NaN|undefined|null|inf|Infinity|-inf)\b|\[object/;
    const see = (words, where) => { const match = wrong.exec(words); if (match) found.push(`${start(words.slice(Math.max(0, match.index - 20)))} (${where}) has the text ${match[0]}`); };
    for (const { words, element } of texts()) see(words, name(element));
    for (const element of document.querySelectorAll('[title], [aria-label], [alt]')) for (const key of ['title', 'aria-label', 'alt']) see(element.getAttribute(key) ?? '', `${key} of ${name(element)}`);
    return said(found);
  }

  /** Anchors that lead nowhere. */
  const lost = () => [...document.querySelectorAll('a[href^="#"]')].filter(a => !document.getElementById(decodeURIComponent(a.getAttribute('href').slice(1)))).map(a => `${start(a.textContent)} leads to ${a.getAttribute('href')}, which is not there`);

  /** Boxes of words, a line each, and of what is clicked, which have no text node; as far as they are seen. */
  function boxes() {
    const clips = new Map();
    function clip(element) {
      if (!element || element === document.documentElement || element === document.body) return { left: -Infinity, right: Infinity, top: -Infinity, bottom: Infinity };
      if (!clips.has(element)) {
        const above = clip(element.parentElement), own = element.getBoundingClientRect(), clipped = getComputedStyle(element).overflow !== 'visible';
        clips.set(element, clipped ? { left: Math.max(above.left, own.left), right: Math.min(above.right, own.right), top: Math.max(above.top, own.top), bottom: Math.min(above.bottom, own.bottom) } : above);
      }
      return clips.get(element);
    }
    const floats = element => { for (let e = element; e; e = e.parentElement) if (['fixed', 'sticky'].includes(getComputedStyle(e).position)) return e; return null; };
    const found = [];
    const add = (element, words, rects, node = null) => {
      const { left, right, top, bottom } = clip(element), above = floats(element);
      for (const rect of rects) {
        const box = { element, node, words, above, left: Math.max(rect.left, left), right: Math.min(rect.right, right), top: Math.max(rect.top, top), bottom: Math.min(rect.bottom, bottom) };
        if (box.right > box.left && box.bottom > box.top) found.push(box);
      }
    };
    for (const { node, element, words } of texts(document.body)) {
      if (element.closest('svg, option')) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      add(element, start(words), range.getClientRects(), node);
    }
    for (const control of document.querySelectorAll('button, select, input')) if (shown(control)) add(control, name(control), [control.getBoundingClientRect()]);
    return found.sort((a, b) => a.top - b.top);
  }

  /** Words that lie on other words or under what is clicked. */
  function collisions() {
    const all = boxes(), found = [], belongs = (control, other) => !control.node && control.element.contains(other.element);
    all.forEach((a, i) => {
      for (let k = i + 1; k < all.length && all[k].top < a.bottom - 4; k++) {
        const b = all[k], x = Math.min(a.right, b.right) - Math.max(a.left, b.left), y = Math.min(a.bottom, b.bottom) - b.top;
        if (x > 2 && y > 4 && a.above === b.above && !(a.node && a.node === b.node) && !belongs(a, b) && !belongs(b, a)) found.push(`${a.words} and ${b.words} lie on each other, by ${whole(x)} px and ${whole(y)} px`);
      }
    });
    return said(found);
  }

  /** Words that end in dots because their place is too small. */
  const shortened = () => said([...document.querySelectorAll('body *')].filter(element => shown(element) && getComputedStyle(element).textOverflow === 'ellipsis' && element.scrollWidth > element.clientWidth + 1)
    .map(element => `${start(element.textContent)} (${name(element)}) shows ${element.clientWidth} px of ${element.scrollWidth} px`));

  /** Words of figures in the page that come out smaller than `least` pixels. */
  const small = least => said([...document.querySelectorAll('body svg')].filter(shown).map(svg => {
    const scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width, sizes = [...svg.querySelectorAll('text')].map(text => parseFloat(getComputedStyle(text).fontSize) * scale), size = Math.min(...sizes);
    return size < least ? `the figure ${start(svg.querySelector('text').textContent)} is ${whole(svg.getBoundingClientRect().width)} px wide, its smallest words are ${size.toFixed(1)} px high and need ${least}` : '';
  }).filter(Boolean));

  /** Headings with nothing under them. */
  const bare = () => [...document.querySelectorAll('section, article, details')].filter(part => shown(part) && ![...part.children].some(child => !/^(H\d|SUMMARY)$/.test(child.tagName) && shown(child) && child.getBoundingClientRect().height > 1)).map(part => `nothing stands under ${start(part.textContent.slice(0, 60))} (${name(part)})`);

  /** Margin of a sheet of paper in pixels, as the page asks for it. */
  function margin() {
    const rules = [...document.styleSheets].flatMap(sheet => [...sheet.cssRules]).flatMap(rule => [rule, ...rule.cssRules ?? []]), rule = rules.find(one => one instanceof CSSPageRule);
    return rule ? parseFloat(rule.style.marginLeft) * { mm: 96 / 25.4, cm: 96 / 2.54, px: 1 }[rule.style.marginLeft.match(/[a-z]+/)[0]] : 0;
  }

  // What is drawn on canvases as text, since they were last cleared.
  const drawn = new Map(), context = CanvasRenderingContext2D.prototype, { fillText, clearRect } = context;
  context.fillText = function (words, x, y, ...rest) {
    const size = this.measureText(words), { e, f, a, b, c, d } = this.getTransform();
    const corners = [[x - size.actualBoundingBoxLeft, y], [x + size.actualBoundingBoxRight, y]].map(([px, py]) => [a * px + c * py + e, b * px + d * py + f]);
    if (!drawn.has(this.canvas)) drawn.set(this.canvas, []);
    drawn.get(this.canvas).push({ words, corners });
    return fillText.call(this, words, x, y, ...rest);
  };
  context.clearRect = function (...rest) {
    drawn.delete(this.canvas);
    return clearRect.apply(this, rest);
  };

  /** Words of charts that leave their canvas. */
  const chopped = () => said([...drawn].filter(([one]) => one.isConnected).flatMap(([{ width, height }, words]) => words
    .filter(({ corners }) => corners.some(([x, y]) => x < -1 || y < -1 || x > width + 1 || y > height + 1))
    .map(({ words: text, corners }) => `${start(text)} is drawn from ${whole(corners[0][0])} px to ${whole(corners[1][0])} px of a canvas of ${width} px`)));

  /** Texts of a figure that lie on each other by more than a pixel of the figure both ways. */
  function overlaps(svg) {
    const scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width, found = [];
    const boxes = [...svg.querySelectorAll('text')].map(text => ({ words: start(text.textContent), box: text.getBoundingClientRect() }));
    boxes.forEach(({ words, box: a }, i) => boxes.slice(i + 1).forEach(({ words: others, box: b }) => {
      const x = (Math.min(a.right, b.right) - Math.max(a.left, b.left)) / scale, y = (Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)) / scale;
      if (x > 1 && y > 1) found.push(`${words} and ${others} lie on each other, by ${x.toFixed(1)} px and ${y.toFixed(1)} px`);
    }));
    return found;
  }

  /** Texts that leave the figure. */
  function outside(svg) {
    const page = svg.getBoundingClientRect(), scale = page.width / svg.viewBox.baseVal.width;
    return [...svg.querySelectorAll('text')].flatMap(text => {
      const box = text.getBoundingClientRect();
      const ways = { left: page.left - box.left, right: box.right - page.right, top: page.top - box.top, bottom: box.bottom - page.bottom };
      return Object.entries(ways).filter(([, by]) => by / scale > 0.5).map(([side, by]) => `${start(text.textContent)} leaves the figure at the ${side} by ${(by / scale).toFixed(1)} px`);
    });
  }

  /** Attributes that hold no number where one is due, and numbers as text that are none. */
  function unlike(svg) {
    const found = [], wrong = /NaN|undefined|null|(?:^|[\s,(+-])inf/i;
    for (const element of svg.querySelectorAll('*')) for (const { name: key, value } of element.attributes) if (wrong.test(value)) found.push(`${key} of ${name(element)} is ${start(value)}`);
    // A law is called h-infinity.
    const odd = /NaN|undefined|null|(?:^|[\s,(]|(?<![a-z])[+-])inf/i;
    for (const text of svg.querySelectorAll('text')) if (odd.test(text.textContent)) found.push(`a text is ${start(text.textContent)}`);
    return said(found);
  }

  const wordless = svg => [...svg.querySelectorAll('text')].filter(text => !text.textContent.trim()).map(text => `the text at ${text.getAttribute('x')}, ${text.getAttribute('y')} is empty`);

  /** Colour behind everything in a figure. */
  const ground = svg => hex(shapes(svg)[0]?.fill ?? paper());
  const darkness = css => light(colour(css));

  window.look = { collisions, shortened, small, bare, margin, chopped, texts, faint, unsaid, sideways, cut, folded, openAll, nameless, leaks, lost, overlaps, outside, unlike, wordless, ground, darkness };
}
