// The clock alone, without a browser.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Clock } from '../src/clock.js';

test('a frame that is stamped before it is asked for does not turn the clock back', () => {
  const clock = new Clock(0, 10);
  clock.play(true);
  clock.advance(-0.06);
  assert.equal(clock.t, 0);
  clock.advance(0.1);
  assert.equal(clock.t, 0.1);
});

test('a page that was in the background does not jump, and the clock stops at the end', () => {
  const clock = new Clock(0, 0.3);
  clock.play(true);
  clock.advance(60);
  assert.equal(clock.t, 0.25);
  clock.advance(60);
  assert.deepEqual([clock.t, clock.playing], [0.3, false]);
});
