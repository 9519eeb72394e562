// The words around the pictures: header, key of the colours, and what is said when there is nothing to show.

import { RAMP } from './theme.js';
import { digits, scaleFor } from './units.js';

const byId = id => document.getElementById(id);
const make = (tag, className, text) => Object.assign(document.createElement(tag), { className, textContent: text ?? '' });

export function sayInstead(sentence) {
  document.body.classList.add('empty');
  byId('sentence').textContent = sentence;
  byId('sentence').hidden = false;
}

export function header(runs) {
  const host = byId('runs');
  document.title = `${runs.map(run => run.name).join(' and ')} · Flexure`;
  runs.forEach((run, r) => {
    const article = make('article', 'run'), head = make('div', 'who'), name = make('h1', '', run.name);
    if (runs.length > 1) name.prepend(make('i', r ? 'dash second' : 'dash'));
    head.append(name);
    if (run.law) head.append(make('span', 'law', `law ${run.law}`));
    article.append(head);
    if (run.verdict) {
      const [kind, mark] = run.verdict.good === null ? ['open', '– not known'] : run.verdict.good ? ['good', '✓ good'] : ['bad', '✕ bad'];
      const verdict = make('p', `verdict ${kind}`);
      verdict.append(make('b', '', mark), make('span', '', run.verdict.words));
      article.append(verdict);
    }
    host.append(article);
  });
}

/** The bar from slack to the largest spring torque, with numbers. */
export function colourBar(largest, units) {
  const { factor, prefix } = scaleFor(largest, 0.1), unit = units.map(word => prefix + word).join(', ');
  byId('ramp').style.background = `linear-gradient(90deg, ${RAMP.join(', ')})`;
  byId('ramp-unit').textContent = unit;
  byId('ramp-numbers').replaceChildren(...[0, 0.5, 1].map(share => make('span', '', digits(share * largest * factor))));
}

/** The choice of the motor side's magnification. */
export function magnificationChoice(auto, changed) {
  const select = byId('magnify'), steps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
  const values = [...new Set([...steps, auto])].sort((a, b) => a - b).filter(value => value <= Math.max(10, 10 * auto));
  select.append(...values.map(value => new Option(`× ${value}${value === auto && auto !== 1 ? ' (auto)' : ''}`, value, value === auto, value === auto)));
  select.addEventListener('change', () => changed(Number(select.value)));
}
