// Puts the page together: the runs in it, the cursor, keys, settings, and the address.

const runs = [...document.querySelectorAll('script.run')];
const comparison = JSON.parse($('comparison').textContent);
const cursor = new Cursor();
let current = 0;
const loaded = [];
let path, wave, panels;

/** The run of this number, unpacked when it is first shown. */
async function loadRun(index) {
  loaded[index] ??= await unpacked(runs[index]);
  return loaded[index];
}

/** Draws the paths of all methods of a comparison, or that of the one that is shown. */
async function showOthers() {
  const all = $('others').getAttribute('aria-pressed') === 'true';
  const others = await Promise.all(all ? runs.map(async (run, index) => ({ name: run.dataset.run, run: await loadRun(index) })) : []);
  path.overlay(others);
}

/** Whether the paths of other methods are drawn too. */
function buildOthers() {
  const others = make('button', { id: 'others', type: 'button', data: { word: 'others' }, hidden: !comparison, onclick: () => {
    others.setAttribute('aria-pressed', String(others.getAttribute('aria-pressed') !== 'true'));
    showOthers();
  } });
  others.setAttribute('aria-pressed', String(Boolean(comparison)));
  $('path-tools').prepend(others);
}

/** Shows another run, at the same clock. */
async function showRun(index) {
  const run = await loadRun(index);
  current = index;
  cursor.show(run);
  $('headline').textContent = comparison?.title ?? run.headline;
  $('choices').textContent = run.title;
  $('choices').title = run.title;
  const time = $('time');
  [time.min, time.max] = [run.first, run.last];
  path.show(run);
  panels.show(run, comparison, index);
  document.body.classList.toggle('without-path', !run.path);
  wave.show(run);
  if (comparison) await showOthers();
  $('run').value = String(index);
  showAlerts(run);
  moved();
}

/** What is wrong, and the greatest error: a click goes there. */
function showAlerts(run) {
  const item = (className, text, title, go) => make('li', {}, make('button', { type: 'button', className, textContent: text, title, onclick: go }));
  const items = [];
  const [event] = run.events;
  if (event) {
    const count = run.events.length > 1 ? `${run.events.length} × ` : '';
    items.push(item('bad', count + event.text, event.text, nextEvent));
  }
  const worst = worstOf(run);
  if (worst) {
    const where = worst.line ? `${word('line')} ${worst.line}` : `${word('clock')} ${shown(worst.clock)}`;
    items.push(item('worst', `${word('worst')} ${worst.error.toFixed(3)} BLU · ${where}`, '', () => cursor.seek(worst.clock)));
  }
  const failure = run.failures.find((text) => text !== 'overflow' && !run.events.some((event) => text.includes(event.text)));
  if (failure) items.push(item('bad', failure, failure, () => panels.open('report')));
  $('alerts').replaceChildren(...items);
}

/** Goes to the next overflow, or to the first again; what lost its carry is selected. */
function nextEvent() {
  const events = cursor.run.events;
  const event = events.find(({ clock }) => clock > cursor.clock) ?? events[0];
  if (!event) return;
  cursor.seek(event.clock);
  const item = wave.shown.find(({ signal }) => signal?.path === event.component);
  item?.element.focus({ preventScroll: true });
  item?.element.scrollIntoView({ block: 'nearest' });
}

/** What is at the cursor, in words. */
function readout(separator) {
  const { run, clock } = cursor;
  const parts = [`${word('clock')} ${shown(clock)}`, timeText(clock / run.clock_hz)];
  const block = run.block(clock);
  if (run.moves.length && block >= 0) parts.push(`${word('block')} ${numberOf(run.moves[block])}`);
  const row = run.row(clock);
  if (row >= 0) parts.push(`${word('step')} ${shown(run.steps.numbers[row])}`);
  if (run.path) parts.push(placeText(run.place(clock)));
  return parts.join(separator);
}

/** Everything follows the cursor. */
function moved() {
  const { clock } = cursor;
  // A table that scrolls asks for the layout: before anything else is written.
  panels.moved();
  path.moved();
  wave.moved();
  const time = $('time');
  time.value = String(clock);
  time.setAttribute('aria-valuetext', readout(', '));
  setText($('readout'), readout('  ·  '));
  if ($('play').dataset.title !== (cursor.isPlaying ? 'pause' : 'play')) setPlay();
  clearTimeout(moved.later);
  moved.later = setTimeout(() => {
    if (!cursor.isPlaying) $('spoken').textContent = readout(', ');
    const address = `#clock=${clock}${runs.length > 1 ? `&run=${current}` : ''}`;
    try { history.replaceState(null, '', address); } catch { /* Some browsers keep the address of a file as it is. */ }
  }, 250);
}

/** A number in the address. */
function addressed(name, hash = location.hash) {
  const number = Number(new URLSearchParams(hash.slice(1)).get(name) ?? NaN);
  return Number.isInteger(number) && number >= 0 ? number : undefined;
}

// Keys

const KEYS = [
  [['ArrowLeft', 'ArrowRight'], '← →', 'key_clock', (by) => cursor.seek(cursor.clock + by)],
  [[',', '.'], ', .', 'key_step', (by) => cursor.step(by)],
  [['PageUp', 'PageDown'], 'PgUp PgDn', 'key_block', (by) => cursor.block(by)],
  [['[', ']'], '[ ]', 'key_change', (by) => wave.selected?.signal && cursor.among(wave.selected.signal.clocks, by)],
  [['Home', 'End'], 'Home End', 'key_ends', (by) => cursor.seek(by > 0 ? cursor.run.last : cursor.run.first)],
  [['ArrowUp', 'ArrowDown'], '↑ ↓', 'key_select', (by) => wave.selectNext(by)],
  [[null, ' '], 'Space', 'key_play', () => cursor.play()],
  [['-', '+'], '+ −', 'key_zoom', (by) => wave.zoom(by > 0 ? 1.6 : 1 / 1.6)],
  [[null, '0'], '0', 'key_fit', () => wave.fit()],
  [[null, 'o'], 'o', 'key_overflow', nextEvent],
  [[null, 'e'], 'e', 'key_worst', () => worstOf(cursor.run) && cursor.seek(worstOf(cursor.run).clock)],
  [[null, 'r'], 'r', 'key_radix', () => otherRadix()],
  [[null, '?'], '?', 'key_help', () => showKeys()],
  [[], '⏎ ⌫', 'key_open'],
];

/** Other numbers for the selected signal. */
function otherRadix() {
  const signal = wave.selected?.signal;
  if (!signal) return;
  const all = [null, 'unsigned', 'signed', 'binary', 'hex'];
  signal.radix = all[(all.indexOf(signal.radix) + 1) % all.length];
  wave.values(true);
  wave.surface.redraw(0);
}

function showKeys() {
  const rows = KEYS.map(([, text, key]) => make('tr', {}, make('th', { textContent: text, scope: 'row' }), make('td', { textContent: word(key) })));
  const title = make('h2', { id: 'keys-title', textContent: word('keys') });
  const close = make('button', { type: 'button', textContent: word('close'), onclick: () => $('keys').close() });
  $('keys').replaceChildren(title, make('table', {}, ...rows), make('h3', { textContent: word('key_mouse') }), make('p', { textContent: word('mouse') }), close);
  if (!$('keys').open) $('keys').showModal();
}

function onKey(event) {
  if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || $('keys').open) return;
  const { target } = event;
  const isText = target.matches('select, input[type=search]');
  const isPressed = target.matches('button, [role=tab]') && [' ', 'Enter'].includes(event.key);
  if (isText || isPressed) return;
  const inTable = target.closest('.grid') && ['ArrowUp', 'ArrowDown', 'PageUp', 'PageDown'].includes(event.key);
  if (inTable && event.key.startsWith('Arrow')) {
    event.preventDefault();
    cursor.step(event.key === 'ArrowDown' ? 1 : -1);
    return;
  }
  if (target.closest('#report-tab') && ['ArrowUp', 'ArrowDown', ' '].includes(event.key)) return;
  if (event.key === 'Enter' && target.closest('#values')) {
    wave.toggle(wave.selected);
    return;
  }
  const key = event.key === '=' ? '+' : event.key;
  const found = KEYS.find(([keys]) => keys.includes(key) || (key.length === 1 && keys.includes(key.toLowerCase())));
  if (!found) return;
  event.preventDefault();
  const by = found[0].indexOf(key) > 0 ? 1 : -1;
  if (event.shiftKey && key.startsWith('Arrow') && found[2] === 'key_clock') cursor.step(by);
  else found[3](by);
}

// Settings

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  $('theme').replaceChildren(sign(name === 'dark' ? 'light' : 'dark'));
  readColours();
  path?.surface.redraw();
  wave?.surface.redraw();
  wave?.ruler.redraw();
}

function setLanguage(name) {
  language = name;
  setWords();
  if (!cursor.run) return;
  panels.methods = null;
  panels.show(cursor.run, comparison, current);
  setWords();
  showAlerts(cursor.run);
  moved();
}

/** Shows whether the cursor plays. */
function setPlay() {
  const play = $('play');
  play.dataset.title = cursor.isPlaying ? 'pause' : 'play';
  play.replaceChildren(sign(play.dataset.title));
  play.title = `${word(play.dataset.title)} (Space)`;
  play.setAttribute('aria-label', play.title);
}

function buildTransport() {
  const play = button('play', 'Space', () => cursor.play());
  play.id = 'play';
  $('transport').append(
    button('first', 'Home', () => cursor.seek(cursor.run.first)), button('before_block', 'PgUp', () => cursor.block(-1)),
    button('before_step', ',', () => cursor.step(-1)), button('before_clock', '←', () => cursor.seek(cursor.clock - 1), '\u22121'), play,
    button('next_clock', '→', () => cursor.seek(cursor.clock + 1), '+1'), button('next_step', '.', () => cursor.step(1)),
    button('next_block', 'PgDn', () => cursor.block(1)), button('last', 'End', () => cursor.seek(cursor.run.last)),
  );
  const speeds = [0.05, 0.25, 1, 4].map((speed) => make('option', { value: String(speed), textContent: `×${speed}`, selected: speed === 1 }));
  const speed = make('select', { id: 'speed', onchange: () => { cursor.speed = Number(speed.value); }, data: { title: 'speed' } }, ...speeds);
  $('transport').append(speed);
}

function listen() {
  $('time').addEventListener('input', () => cursor.seek(Number($('time').value), true));
  $('radix').addEventListener('change', () => {
    cursor.radix = $('radix').value;
    wave.values(true);
    wave.surface.redraw(0);
    panels.moved();
  });
  $('language').addEventListener('click', () => setLanguage(language === 'en' ? 'zh' : 'en'));
  $('theme').dataset.title = 'theme';
  $('theme').addEventListener('click', () => setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'));
  const dark = matchMedia('(prefers-color-scheme: dark)');
  dark.addEventListener('change', () => setTheme(dark.matches ? 'dark' : 'light'));
  $('help').addEventListener('click', showKeys);
  $('run').append(...runs.map((run, index) => make('option', { value: String(index), textContent: run.dataset.run })));
  $('run').addEventListener('change', () => showRun(Number($('run').value)));
  $('run-choice').hidden = runs.length < 2;
  addEventListener('keydown', onKey);
  // The address as it was given: a move of the cursor may have written another since.
  addEventListener('hashchange', ({ newURL }) => {
    const clock = addressed('clock', new URL(newURL).hash);
    if (clock !== undefined) cursor.seek(clock);
  });
  cursor.followers.push(moved);
  setTheme(dark.matches ? 'dark' : 'light');
}

async function begin() {
  if (typeof DecompressionStream === 'undefined') {
    $('loading').textContent = WORDS.en.no_stream;
    return;
  }
  readColours();
  path = new PathView(cursor);
  wave = new WaveView(cursor);
  panels = new Panels(cursor, showRun);
  buildTransport();
  buildOthers();
  listen();
  language = (navigator.language ?? '').toLowerCase().startsWith('zh') ? 'zh' : 'en';
  setWords();
  await showRun(Math.min(runs.length - 1, addressed('run') ?? 0));
  setWords();
  cursor.seek(addressed('clock') ?? cursor.clock);
  wave.values(true);
  $('loading').remove();
  document.documentElement.dataset.ready = 'true';
}

/** For scripts: the cursor, and the value of a signal at it, as in the step table and as text. */
window.stepwave = {
  seek(clock) {
    cursor.seek(clock);
    wave.values(true);
  },
  value(name) {
    const signals = cursor.run.signals.filter(({ path }) => path === name || path.endsWith(`.${name}`));
    const signal = signals.find(({ path }) => path === name) ?? signals[0];
    return signal && String(signal.number(signal.bits(cursor.clock)));
  },
  /** The row of the step table that is valid at the cursor, as its cells. */
  row() {
    const row = cursor.run.row(cursor.clock);
    return row < 0 ? null : panels.cells(row);
  },
  show: showRun,
  /** The clocks between which the wave is in view. */
  get view() { return [wave.from, wave.to]; },
  get clock() { return cursor.clock; },
  get clocks() { return [cursor.run.first, cursor.run.last]; },
};

begin();
