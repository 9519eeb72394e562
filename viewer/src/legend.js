// The table under the charts' names: every joint with its colour, its values at the cursor, and whether it is drawn.

import { locate, rmsOf, valueAt } from './data.js';
import { digits, seconds } from './units.js';
import { palette } from './theme.js';

const COLOURS = 8;
/** More joints than MANY start with the FEW that err most. */
const MANY = 7, FEW = 6;

/** The joints of all runs by name; a joint takes the first free colour when it is switched on. */
export class Joints {
  constructor(runs) {
    const names = [...new Set(runs.flatMap(run => run.names))];
    this.list = names.map(name => ({ name, at: runs.map(run => run.names.indexOf(name)), shown: false, colour: 0 }));
    const error = joint => Math.max(...joint.at.map((j, r) => (j < 0 ? 0 : rmsOf(runs[r], runs[r].error[j]))));
    const worst = [...this.list].sort((a, b) => error(b) - error(a)).slice(0, names.length > MANY ? FEW : names.length);
    for (const joint of this.list) if (worst.includes(joint)) this.show(joint, true);
    // Those that are drawn come first in a long table.
    if (names.length > MANY) this.list.sort((a, b) => b.shown - a.shown);
  }

  show(joint, on) {
    joint.shown = on;
    if (!on) return;
    const used = new Array(COLOURS).fill(0);
    for (const other of this.list) if (other !== joint && other.shown) used[other.colour]++;
    joint.colour = used.indexOf(Math.min(...used));
  }

  get shown() { return this.list.filter(joint => joint.shown); }
}

export class Legend {
  constructor(host, runs, quantities, joints, changed) {
    Object.assign(this, { host, runs, quantities: quantities.filter(quantity => !quantity.whole), joints, changed, at: { k: 0, f: 0 } });
    const table = document.createElement('table');
    table.innerHTML = `<thead><tr><th scope="col"><span class="when"></span></th>${this.quantities.map(q => `<th scope="col">${q.title}<small>${q.words}</small></th>`).join('')}</tr></thead>`;
    const body = table.createTBody();
    this.rows = joints.list.map(joint => {
      const row = body.insertRow(), head = document.createElement('th'), button = document.createElement('button'), swatch = document.createElement('i');
      head.scope = 'row';
      button.type = 'button';
      button.append(swatch, joint.name);
      button.title = `${joint.name}: show or hide in the charts`;
      button.addEventListener('click', () => { joints.show(joint, !joint.shown); this.theme(); changed(); });
      head.append(button);
      row.append(head);
      const cells = this.quantities.map(() => runs.map((_, r) => {
        const value = document.createElement('span');
        if (r) value.className = 'second';
        return value;
      }));
      for (const values of cells) row.insertCell().append(...values);
      return { joint, row, button, swatch, cells };
    });
    this.when = table.querySelector('.when');
    this.note = document.createElement('p');
    host.append(table, this.note);
    this.theme();
  }

  theme() {
    for (const { joint, row, button, swatch } of this.rows) {
      row.classList.toggle('off', !joint.shown);
      button.setAttribute('aria-pressed', joint.shown);
      swatch.style.background = joint.shown ? palette().joints[joint.colour] : '';
    }
    const all = this.rows.length, shown = this.joints.shown.length;
    this.note.textContent = all > MANY ? `${shown} of ${all} joints drawn; at the start those with the largest error. Click a name to add or drop it.` : '';
    this.note.hidden = all <= MANY;
  }

  /** Values at time t. */
  show(t, hovered) {
    this.when.textContent = `${hovered ? 'at mouse, ' : ''}${seconds(t)}`;
    for (const { joint, cells } of this.rows) {
      joint.at.forEach((j, r) => {
        const run = this.runs[r], inside = t >= run.begin && t <= run.end + 1e-9;
        locate(run, t, this.at);
        this.quantities.forEach((quantity, c) => {
          const text = j < 0 || !inside ? '\u2013' : digits(quantity.factor * valueAt(run[quantity.key][j], this.at)), cell = cells[c][r];
          if (cell.textContent !== text) cell.textContent = text;
        });
      });
    }
  }
}
