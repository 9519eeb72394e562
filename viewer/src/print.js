// On paper: white, still pictures in place of the 3-D canvases, charts as wide as the sheet.

import { setPaper } from './theme.js';

const SHEET = 690, STRIP = 150, PICTURE = 380;

export function forPaper(panels, charts, layout) {
  let on = false;
  const begin = () => {
    if (on) return;
    on = true;
    setPaper(true);
    for (const panel of panels) {
      const wide = SHEET / panels.length, still = new Image(wide, PICTURE);
      // The sheet is laid out at once; it cannot wait for the picture.
      still.decoding = 'sync';
      still.className = 'still';
      still.alt = `The robot of run ${panel.run.name}`;
      still.src = panel.picture(wide, PICTURE);
      panel.host.append(still);
    }
    charts.draw(STRIP, SHEET);
  };
  const end = () => {
    if (!on) return;
    on = false;
    document.querySelectorAll('img.still').forEach(image => image.remove());
    setPaper(false);
    layout();
  };
  addEventListener('beforeprint', begin);
  addEventListener('afterprint', end);
  matchMedia('print').addEventListener('change', event => (event.matches ? begin() : end()));
}
