// Search over headings and text. The index is loaded when the field is first used; it needs no server.
(() => {
  const form = document.querySelector('.search'), field = form.querySelector('input'), list = form.querySelector('ol');
  const root = document.documentElement.dataset.root;
  const fold = text => text.toLowerCase().normalize('NFD').replace(/[\u0300-\u036f]/g, '');
  let index = null, wanted = false;

  function load() {
    if (wanted) return;
    wanted = true;
    const script = Object.assign(document.createElement('script'), { src: `${root}site/index.js` });
    script.onload = () => {
      index = window.searchIndex.map(([page, heading, address, text]) => ({ page, heading, address, text, title: fold(`${page} ${heading}`), folded: fold(text) }));
      show();
    };
    document.head.append(script);
  }

  /** How well a section fits: every word must be somewhere; titles count most, and whole words more than parts. */
  function score(section, words) {
    let sum = words.length > 1 && section.folded.includes(words.join(' ')) ? 12 : 0;
    for (const word of words) {
      const inTitle = section.title.indexOf(word), inText = section.folded.split(word).length - 1;
      if (inTitle < 0 && !inText) return 0;
      sum += (inTitle < 0 ? 0 : /(^|\W)$/.test(section.title.slice(0, inTitle)) ? 30 : 15) + Math.min(inText, 8);
    }
    return sum;
  }

  function show() {
    const words = fold(field.value).split(/\s+/).filter(Boolean);
    list.hidden = !words.length || !index;
    if (list.hidden) return;
    const found = index.map(section => ({ section, points: score(section, words) })).filter(({ points }) => points);
    found.sort((a, b) => b.points - a.points);
    list.replaceChildren(...found.slice(0, 12).map(({ section }) => {
      // From the start of a word, some words before what was looked for.
      const at = section.text.lastIndexOf(' ', Math.max(0, section.folded.indexOf(words.length > 1 ? words.join(' ') : words[0]), section.folded.indexOf(words[0])) - 40) + 1, item = document.createElement('li'), link = document.createElement('a');
      const part = (tag, text) => Object.assign(document.createElement(tag), { textContent: text });
      link.href = root + section.address;
      link.append(part('b', section.heading || section.page), part('i', section.heading ? section.page : ''), part('span', (at ? '… ' : '') + section.text.slice(at, at + 150).replace(/\s\S*$/, section.text.length > at + 150 ? ' …' : '$&')));
      item.append(link);
      return item;
    }));
    if (!found.length) list.append(Object.assign(document.createElement('li'), { textContent: 'Nothing found.', className: 'none' }));
  }

  form.hidden = false;
  field.addEventListener('focus', load);
  field.addEventListener('input', () => { load(); show(); });
  form.addEventListener('submit', event => { event.preventDefault(); list.querySelector('a')?.click(); });
  form.addEventListener('keydown', event => {
    const all = [field, ...list.querySelectorAll('a')], step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) { event.preventDefault(); all[(all.indexOf(document.activeElement) + step + all.length) % all.length].focus(); }
    if (event.key === 'Escape') { field.value = ''; list.hidden = true; field.blur(); }
  });
  document.addEventListener('click', event => { if (!form.contains(event.target)) list.hidden = true; });
  document.addEventListener('keydown', event => { if (event.key === '/' && !/^(INPUT|TEXTAREA)$/.test(event.target.tagName)) { event.preventDefault(); field.focus(); } });
})();
