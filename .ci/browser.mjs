// Opens pages in Chromium and compares what they show: see .ci/browser.
import { createRequire } from 'node:module';
import { existsSync, mkdtempSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { deflateSync, inflateSync } from 'node:zlib';
import assert from 'node:assert/strict';

const [folder, mode] = process.argv.slice(2);
const { chromium } = createRequire(join(folder, 'x'))('playwright-core');
const ARGS = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync'];

/** A browser with a profile of its own, and what went wrong in it. */
async function browser(options = {}) {
  const profile = mkdtempSync(join(tmpdir(), 'page-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: '/usr/bin/chromium', headless: true, args: ARGS, viewport: { width: 1280, height: 800 }, locale: 'en-US', ...options,
  });
  const [page] = context.pages();
  const wrong = [];
  page.on('console', (message) => wrong.push(`${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => wrong.push(String(error.stack)));
  page.on('request', (request) => request.url().startsWith('file:') || wrong.push(`request: ${request.url()}`));
  const open = async (file, hash = '') => {
    await page.goto('about:blank');
    await page.goto(`file://${join(folder, file)}${hash}`);
    await page.waitForSelector('html[data-ready]', { timeout: 60_000 });
  };
  return { context, page, open, wrong };
}

/** A VCD: for each path its bits in time, and whether it is signed. */
function readVcd(file) {
  const text = readFileSync(file, 'utf8');
  const [, hz] = /clock ([\d.e+]+) Hz/.exec(text);
  const [, size, unit] = /\$timescale\s+(\d+)\s*(\w+)\s+\$end/.exec(text);
  const ticks = 1 / Number(hz) / Number(size) / { s: 1, ms: 1e-3, us: 1e-6, ns: 1e-9, ps: 1e-12, fs: 1e-15 }[unit];
  const scopes = [], names = [], changes = new Map();
  let time = 0;
  for (const line of text.split('\n')) {
    const words = line.trim().split(/\s+/);
    if (words[0] === '$scope') scopes.push(words[2]);
    else if (words[0] === '$upscope') scopes.pop();
    else if (words[0] === '$var') {
      names.push({ path: [...scopes, words[4]].join('.'), kind: words[1], width: Number(words[2]), id: words[3] });
      changes.set(words[3], changes.get(words[3]) ?? []);
    } else if (/^#\d/.test(line)) time = Number(line.slice(1));
    else if (/^[01]./.test(line)) changes.get(line.slice(1)).push([time, line[0]]);
    else if (/^b/.test(line)) changes.get(words[1]).push([time, words[0].slice(1)]);
  }
  const at = ({ id }, clock) => {
    const before = changes.get(id).filter(([when]) => when <= Math.round(clock * ticks));
    return before.at(-1)[1];
  };
  return { names: names.filter(({ path }) => !path.endsWith('.clk')), at };
}

/** The number that bits of a variable mean. */
function numberOf({ kind, width }, bits, isSigned) {
  const word = BigInt(`0b${bits}`);
  return kind === 'integer' || isSigned ? BigInt.asIntN(width, word) : word;
}

function readCsv(file) {
  const [head, ...rows] = readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return { head, rows };
}

/** Ten clocks of a run: both ends, some in between, and where rows of the step table begin. */
function clocksOf([first, last], rows, clock) {
  const spread = [0, 1, 0.07, 0.21, 0.5, 0.77].map((part) => Math.round(first + part * (last - first)));
  const steps = [0.1, 0.33, 0.6, 0.9].map((part) => Number(rows[Math.floor(part * rows.length)]?.[clock] ?? first + 1));
  return [...spread, ...steps].map((at) => Math.min(last, Math.max(first, at)));
}

/** What a page shows at a clock: values of signals, the marked row and the heading of the step table, and the readout. */
async function shownAt(page, clock, how) {
  // The page writes its address a moment after a move: without it, the same address again would not be a change.
  if (how === 'address') await page.evaluate((to) => { history.replaceState(null, '', '#'); location.hash = `#clock=${to}`; }, clock);
  else await page.evaluate((to) => stepwave.seek(to), clock);
  await page.waitForFunction((to) => stepwave.clock === to, clock);
  return page.evaluate(async () => {
    stepwave.seek(stepwave.clock);
    await new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); });
    const texts = (selector) => [...document.querySelectorAll(selector)].map((element) => element.textContent);
    const values = [...document.querySelectorAll('#values [data-name]')].map(({ dataset }) => [dataset.name, dataset.value]);
    return {
      values: Object.fromEntries(values), row: texts('#steps-tab [aria-current] [role=gridcell]'),
      head: texts('#steps-tab [role=columnheader]'), readout: document.getElementById('readout').textContent,
    };
  });
}

/** A page shows at ten clocks what the wave and the step table of the same run hold. */
async function compare({ page, open }, name, decimal = []) {
  await open(`${name}/page.html`);
  const vcd = readVcd(join(folder, name, 'wave.vcd'));
  const csvFile = join(folder, name, 'steps.csv');
  const csv = existsSync(csvFile) ? readCsv(csvFile) : { head: [], rows: [] };
  const clock = csv.head.indexOf('clock');
  const range = await page.evaluate(() => stepwave.clocks);
  if (csv.rows.length) await page.click('#steps-button');
  const clocks = clocksOf(range, csv.rows, clock);
  assert.equal(clocks.length, 10);
  for (const [index, at] of clocks.entries()) {
    const shown = await shownAt(page, at, index % 2 ? 'address' : 'call');
    assert.deepEqual(Object.keys(shown.values).sort(), vcd.names.map(({ path }) => path).sort(), name);
    for (const variable of vcd.names) {
      const bits = vcd.at(variable, at);
      const leaf = variable.path.split('.').at(-1);
      const wanted = decimal.includes(leaf) ? BigInt(BigInt(`0b${bits}`).toString(16)) : numberOf(variable, bits);
      const shownValue = BigInt(shown.values[variable.path]);
      const alike = variable.kind === 'parameter' ? BigInt.asUintN(variable.width, shownValue) === wanted : shownValue === wanted;
      assert.ok(alike, `${name} at ${at}: ${variable.path} is ${wanted} in the wave, ${shownValue} in the page`);
    }
    const inWindow = csv.rows.filter((row) => row[clock] >= range[0] && row[clock] <= at).at(-1);
    if (inWindow) {
      assert.deepEqual(shown.head, csv.head, name);
      assert.deepEqual(shown.row, inWindow, `${name} at ${at}`);
    }
    const place = /\(([^)]*)\)/.exec(shown.readout)?.[1].replaceAll('\u2212', '-').replaceAll('\u202f', '').split(', ');
    for (const [axis, coordinate] of (place ?? []).entries()) {
      const counter = vcd.names.find(({ path }) => path.endsWith(`.${'xyz'[axis]}`) && path.split('.').length === 3);
      // At reset a counter is not yet where the machine is.
      if (counter && at > 0) assert.equal(BigInt(coordinate), numberOf(counter, vcd.at(counter, at), true), `${name} at ${at}`);
    }
  }
  const drawn = await compareDiagram(page, name, vcd, clocks);
  console.log(`${name}: ${clocks.length} clocks, ${vcd.names.length} signals, ${csv.rows.length} rows, ${drawn} values in the diagram: alike`);
}

/** The description of the first run of a page, and the run as bytes, how long the description is, and as text. */
function unpacked(file) {
  const text = readFileSync(join(folder, file), 'utf8');
  const packed = /class="run"[^>]*>([^<]*)</.exec(text)[1];
  const all = inflateSync(Buffer.from(packed, 'base64'));
  const length = all.readUInt32LE(0);
  return { text, packed, all, length, meta: JSON.parse(all.subarray(4, 4 + length)) };
}

/** The block diagram shows at its wires what the wave holds, and the flags that are raised. */
async function compareDiagram(page, name, vcd, clocks) {
  await page.click('#diagram-button');
  const { meta } = unpacked(`${name}/page.html`);
  const netOf = new Map(meta.signals.map(({ scopes, name: leaf, nets }) => [[...scopes, leaf].join('.'), nets.length === 1 ? meta.nets[nets[0]]?.[0] : undefined]));
  const seen = new Set();
  const compareAt = async (at) => {
    await shownAt(page, at, 'call');
    const drawn = await page.evaluate(() => ({
      texts: [...document.querySelectorAll('#diagram-tab text[data-net]')].map(({ dataset, textContent }) => [Number(dataset.net), dataset.value, textContent]),
      raised: [...document.querySelectorAll('#diagram-tab .raised')].flatMap(({ dataset }) => dataset.component.split(' ')),
      listed: Object.fromEntries([...document.querySelectorAll('#values [data-name]')].map((item) => [item.dataset.name, item.querySelector('.value').textContent])),
    }));
    for (const variable of vcd.names) {
      const bits = BigInt(`0b${vcd.at(variable, at)}`);
      for (const [net, value, text] of drawn.texts.filter(([net]) => net === netOf.get(variable.path))) {
        assert.equal(BigInt(value), bits, `${name} at ${at}: ${variable.path} in the diagram`);
        if (variable.kind !== 'parameter') assert.equal(text, drawn.listed[variable.path], `${name} at ${at}: ${variable.path} as text`);
        seen.add(net);
      }
      const isFlag = meta.signals.some(({ role, scopes, name: leaf }) => role === 'flag' && [...scopes, leaf].join('.') === variable.path);
      if (isFlag && bits === 1n) assert.ok(drawn.raised.includes(variable.path), `${name} at ${at}: ${variable.path} is raised`);
    }
    if (!vcd.names.some((variable) => BigInt(`0b${vcd.at(variable, at)}`) === 1n && meta.signals.some(({ role, scopes, name: leaf }) => role === 'flag' && [...scopes, leaf].join('.') === variable.path))) {
      assert.deepEqual(drawn.raised, [], `${name} at ${at}`);
    }
  };
  for (const at of clocks) await compareAt(at);
  const whole = seen.size;
  if (meta.diagrams) assert.ok(whole > 2, `${name}: ${whole} values in the diagram`);
  // Every scope that is a box in one drawing has one of its own, which is opened and left by keys.
  let drawings = 1;
  const inside = async () => {
    const boxes = await page.$$eval('.sheet .opens', (all) => all.map(({ dataset }) => dataset.scope));
    assert.equal(boxes.length, await page.locator('.sheet .closed').count(), name);
    for (const scope of boxes) {
      await page.focus(`.sheet [data-scope="${scope}"]`);
      await page.keyboard.press(drawings % 2 ? 'Enter' : 'Space');
      assert.equal(await page.getAttribute('.sheet', 'aria-label'), `Block diagram: ${scope}`);
      drawings += 1;
      await compareAt(clocks[3]);
      await inside();
      await page.keyboard.press(drawings % 2 ? 'Escape' : 'Backspace');
      assert.equal(await page.evaluate(() => document.activeElement.dataset.scope), scope);
    }
  };
  await inside();
  assert.equal(drawings, meta.diagrams?.length ?? 1, name);
  if (drawings > 1) assert.ok(seen.size > whole, `${name}: ${seen.size} values in all drawings, ${whole} in the first`);
  return seen.size;
}

/** Boxes of a block diagram are opened by a click, but not by a drag, and left by the list of what is above them. */
async function boxes({ page, open }) {
  await open('nurbs/page.html', '#clock=900');
  await page.click('#diagram-button');
  const label = () => page.getAttribute('.sheet', 'aria-label');
  const whole = await label();
  const clock = await page.evaluate(() => stepwave.clock);
  // A reader of the screen finds it as a button with the name of its scope and what is in it.
  const box = page.locator('.sheet .opens').first();
  const scope = await box.getAttribute('data-scope');
  assert.equal(await page.getByRole('button', { name: new RegExp(`^Open ${scope.replaceAll('.', '[.]')}: .*register`) }).count(), 1);
  assert.deepEqual(await page.$$eval('.crumbs li', (all) => all.map(({ textContent }) => textContent)), [whole.split(': ')[1]]);
  // A title is in it, where no reader can point at anything else.
  await page.evaluate(() => document.querySelector('.sheet .opens').scrollIntoView({ block: 'center', inline: 'center' }));
  const { x, y, width, height } = await box.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + 30, y + height / 2 + 20, { steps: 4 });
  await page.mouse.up();
  assert.equal(await label(), whole);
  const title = await page.evaluate(() => document.querySelector('.sheet .opens').getBoundingClientRect().toJSON());
  await page.mouse.click(title.x + title.width / 4, title.y + title.height / 8);
  assert.equal(await label(), `Block diagram: ${scope}`);
  assert.equal(await page.evaluate(() => document.activeElement.className), 'sheet');
  await page.click('#language');
  assert.equal(await label(), `框图: ${scope}`);
  await page.click('#language');
  await page.screenshot({ path: join(folder, 'box.png') });
  assert.equal((await page.$$('.crumbs li')).length, 2);
  await page.click('.crumbs button');
  assert.equal(await label(), whole);
  assert.equal(await page.evaluate(() => document.activeElement.dataset.scope), scope);
  await page.screenshot({ path: join(folder, 'boxes.png') });
  // Neither opened nor left by keys that are for time elsewhere; those that open nothing are.
  assert.equal(await page.evaluate(() => stepwave.clock), clock);
  console.log('boxes of a block diagram open and close by keys and by clicks');
}

/** Keys move the cursor, from wherever the focus is. */
async function keys({ page, open }) {
  const clock = () => page.evaluate(() => stepwave.clock);
  const settled = () => page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));
  const press = async (key, wanted) => {
    await page.keyboard.press(key);
    assert.equal(await clock(), wanted, key);
    await settled();
  };
  await open('trap/page.html');
  await press('ArrowRight', 1);
  await press('ArrowRight', 2);
  await press('.', 5);
  await press('.', 9);
  await press('ArrowLeft', 8);
  await press(',', 5);
  await press('End', 15);
  await press('Home', 0);
  await press('o', 15);
  await press('e', 5);
  await page.focus('#time');
  await press('ArrowRight', 6);
  assert.match(await page.getAttribute('#time', 'aria-valuetext'), /^clock 6, 6 µs, step 1, \(1, 0\)$/);
  await page.waitForFunction(() => document.getElementById('spoken').textContent.startsWith('clock 6, '));
  await page.focus('#steps-tab .grid');
  await press('ArrowDown', 9);
  await press('ArrowUp', 5);
  const active = await page.getAttribute('#steps-tab .grid', 'aria-activedescendant');
  assert.equal(await page.getAttribute(`#${active}`, 'aria-current'), 'true');
  await page.click('.alerts .bad');
  assert.equal(await clock(), 15);
  await page.click('.alerts .worst');
  assert.equal(await clock(), 5);
  await page.click('#values [data-name="ppc_line.f"]');
  await press(']', 8);
  await press('[', 4);
  const value = () => page.textContent('#values [data-name="ppc_line.f"] .value');
  assert.equal(await value(), '-4');
  for (const wanted of ['4', '-4', '100', '4', '-4']) {
    await page.keyboard.press('r');
    assert.equal(await value(), wanted);
  }
  await page.selectOption('#radix', 'binary');
  assert.equal(await value(), '100');
  await page.keyboard.press('?');
  await page.keyboard.press('Escape');
  await page.evaluate(() => stepwave.seek(0));
  await page.focus('#waves').catch(() => {});
  await page.click('#play');
  await page.waitForFunction(() => stepwave.clock > 1);
  await page.click('#play');
  await open('part/page.html');
  const begun = await page.evaluate(() => stepwave.clock);
  await page.keyboard.press('PageDown');
  assert.ok(await clock() > begun, 'a block on');
  await page.click('#program-tab [data-row="9"]');
  await settled();
  const line = await page.textContent('#program-tab [aria-current] span');
  assert.equal(line, '10');
  await open('compare.html');
  for (const [row, model] of [[0, 'ppc-line'], [2, 'dda-line'], [7, 'mindev-line']]) {
    await page.click(`#methods-tab [data-row="${row}"]`);
    await page.waitForFunction((name) => document.getElementById('choices').textContent.startsWith(name), model);
    await page.keyboard.press('End');
    await settled();
    assert.match(await page.textContent('#readout'), /\(100, 62\)$/);
  }
  const names = await page.$$eval('#run option', (all) => all.map((option) => option.textContent));
  const others = () => page.$$eval('#legend .other', (all) => all.map((item) => item.textContent));
  const picture = () => page.$eval('#path canvas', (canvas) => canvas.toDataURL());
  assert.deepEqual(await others(), names.filter((name) => name !== 'mindev-line'), 'the paths of all methods');
  const together = await picture();
  await page.click('#others');
  await settled();
  assert.deepEqual(await others(), []);
  assert.notEqual(await picture(), together, 'one path alone is another picture');
  console.log('keys, buttons, moves and methods: as they should');
}

/** Texts that have too little contrast with what is under them, by WCAG 2 AA. */
function lowContrast() {
  const channels = (colour) => colour.match(/[\d.]+/g).map(Number);
  const over = ([r, g, b, a = 1], below) => [r, g, b].map((channel, at) => channel * a + below[at] * (1 - a));
  const luminance = (colour) => colour.map((channel) => channel / 255)
    .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, at) => sum + c * [0.2126, 0.7152, 0.0722][at], 0);
  const ground = (element) => {
    if (!element) return [255, 255, 255];
    return over(channels(getComputedStyle(element).backgroundColor), ground(element.parentElement));
  };
  const texts = [...document.querySelectorAll('body *')].filter((element) => element.checkVisibility({ visibilityProperty: true })
    && [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim()));
  return texts.flatMap((element) => {
    const below = ground(element);
    const [a, b] = [luminance(over(channels(getComputedStyle(element).color), below)), luminance(below)];
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    return ratio < 4.5 ? [`${element.textContent.trim().slice(0, 30)}: ${ratio.toFixed(2)}`] : [];
  });
}

/** Zoom and pan: keys, wheel, two fingers. */
async function zoom({ context, page, open }) {
  const view = () => page.evaluate(() => stepwave.view);
  const length = async () => { const [from, to] = await view(); return to - from; };
  await open('part/page.html');
  const whole = await length();
  await page.keyboard.press('+');
  assert.ok(await length() < whole / 1.5);
  await page.keyboard.press('0');
  assert.equal(await length(), whole);
  const box = await (await page.$('#waves')).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.keyboard.down('Control');
  await page.mouse.wheel(0, -300);
  await page.keyboard.up('Control');
  await page.waitForFunction((before) => stepwave.view[1] - stepwave.view[0] < before * 0.8, whole);
  const [from] = await view();
  await page.keyboard.down('Shift');
  await page.mouse.wheel(0, 120);
  await page.keyboard.up('Shift');
  await page.waitForFunction((before) => stepwave.view[0] > before, from);
  const near = await length();
  const session = await context.newCDPSession(page);
  const touch = (type, apart) => session.send('Input.dispatchTouchEvent', {
    type, touchPoints: apart ? [{ x: x - apart, y, id: 1 }, { x: x + apart, y, id: 2 }] : [],
  });
  await touch('touchStart', 40);
  for (const apart of [60, 90, 120]) await touch('touchMove', apart);
  await touch('touchEnd', 0);
  await page.waitForFunction((before) => stepwave.view[1] - stepwave.view[0] < before / 2, near);
  await page.selectOption('#plane', { label: 'XZ' });
  console.log('zoom and pan by keys, wheel and fingers: as they should');
}

/** A block diagram in a page: texts and elements with the index of a net follow the cursor. */
async function diagram({ page, open }) {
  const { text, packed, all, length, meta } = unpacked('trap/page.html');
  const net = (name) => meta.nets[meta.signals.find((signal) => signal.name === name).nets[0]][0];
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 60"><g data-component="ppc_line.f_add_overflow ppc_line.f_sub_overflow"><rect width="60" height="40"/></g>`
    + `<text id="of-f" y="20" data-net="${net('f')}"/><path id="of-x" d="M0 0h9" data-net="${net('take_x')}"/></svg>`;
  meta.diagrams = [{ scope: 'ppc_line', svg }];
  const json = Buffer.from(JSON.stringify(meta));
  const head = Buffer.alloc(4);
  head.writeUInt32LE(json.length);
  const again = deflateSync(Buffer.concat([head, json, all.subarray(4 + length)])).toString('base64');
  writeFileSync(join(folder, 'diagram.html'), text.replace(packed, again));
  await open('diagram.html');
  await page.click('#diagram-button');
  for (const [clock, f, x, raised] of [[4, '-4', '1', false], [8, '2', '0', false], [15, '-2', '0', true]]) {
    await shownAt(page, clock, 'call');
    assert.equal(await page.textContent('#of-f'), f);
    assert.equal(await page.getAttribute('#of-x', 'data-value'), x);
    assert.equal(await page.evaluate(() => document.querySelector('#diagram-tab [data-component]').classList.contains('raised')), raised);
  }
  console.log('a block diagram follows the cursor');
}

/** Contrast in light and dark; both languages; nothing wider than a small screen. */
async function looks({ page, open }) {
  for (const name of ['trap/page', 'part/page', 'compare', 'own/page']) {
    await open(`${name}.html`, '#clock=15');
    for (const theme of ['light', 'dark']) {
      await page.evaluate((to) => document.documentElement.dataset.theme === to || document.getElementById('theme').click(), theme);
      for (const tab of await page.$$('#tabs [role=tab]:not([hidden])')) {
        await tab.click();
        await page.waitForTimeout(150);
        assert.deepEqual(await page.evaluate(lowContrast), [], `${name} ${theme}`);
      }
    }
    await page.click('#language');
    assert.equal(await page.textContent('#wave-title'), '波形');
    assert.equal(await page.evaluate(() => document.documentElement.lang), 'zh-CN');
    await page.setViewportSize({ width: 400, height: 800 });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 400), `${name}: 400 pixels`);
    await page.setViewportSize({ width: 1280, height: 800 });
    const unnamed = await page.evaluate(() => [...document.querySelectorAll('button, select, input')]
      .filter((element) => !element.hidden && !(element.getAttribute('aria-label') || element.textContent.trim() || element.labels?.length))
      .map((element) => element.outerHTML));
    assert.deepEqual(unnamed, []);
  }
  console.log('contrast, languages, a small screen: as they should');
}

/** What the tool travelled is the same drawn move by move, forwards and backwards, as drawn at once. */
async function travels({ page, open }) {
  await open('arc/page.html');
  const differ = await page.evaluate(async () => {
    const frame = () => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); });
    const layer = document.querySelectorAll('#path canvas')[1];
    const drawn = () => {
      const copy = Object.assign(document.createElement('canvas'), { width: layer.width, height: layer.height });
      const context = copy.getContext('2d', { willReadFrequently: true });
      context.drawImage(layer, 0, 0);
      return context.getImageData(0, 0, layer.width, layer.height).data.filter((_, at) => at % 4 === 3);
    };
    const counts = [];
    for (const parts of [[0.1, 0.2, 0.35, 0.6], [0.9, 0.8, 0.7, 0.6], [0.2, 0.9, 0.3, 0.95, 0.6]]) {
      for (const part of parts) {
        stepwave.seek(Math.floor(part * stepwave.clocks[1]));
        await frame();
      }
      const moved = drawn();
      for (const _ of [0, 1]) {
        document.getElementById('theme').click();
        await frame();
      }
      counts.push(drawn().filter((opacity, at) => Math.abs(opacity - moved[at]) > 90).length, moved.filter((opacity) => opacity > 200).length);
    }
    return counts;
  });
  for (let at = 0; at < differ.length; at += 2) assert.ok(differ[at] <= 12 && differ[at + 1] > 100, `${differ}`);
}

async function check() {
  const one = await browser();
  const decimal = ['jvx', 'jvy', 'jrx', 'jry', 'jvx_in', 'jvy_in', 'jrx_in', 'jry_in'];
  for (const name of ['line', 'arc', 'trap', 'data', 'spline', 'nurbs', 'window', 'part', 'own', 'imported']) await compare(one, name);
  await compare(one, 'decimal', decimal);
  await keys(one);
  await zoom(one);
  await diagram(one);
  await boxes(one);
  await travels(one);
  await looks(one);
  await one.context.close();
  assert.deepEqual(one.wrong, []);
  console.log('no request, no message of the browser');
}

/** Sizes, load times, and frames a second while scrubbing: the cursor goes to another clock in every frame. Script and layout are the time that a frame takes of a core for each, whatever else runs. */
async function measure() {
  for (const radius of [31, 3125, 31250]) {
    const { context, page, open } = await browser();
    const file = `circle${radius}.html`;
    const begun = performance.now();
    await open(file);
    const load = performance.now() - begun;
    const browserOf = await context.newCDPSession(page);
    await browserOf.send('Performance.enable');
    const spent = async () => new Map((await browserOf.send('Performance.getMetrics')).metrics.map(({ name, value }) => [name, value * 1000]));
    const before = await spent();
    const { rate, slow, clocks } = await page.evaluate(async () => {
      const [first, last] = stepwave.clocks;
      const frame = () => new Promise((done) => { requestAnimationFrame(done); });
      const time = document.getElementById('time');
      const count = 300, frames = [];
      let before = await frame();
      for (let at = 0; at < count; at++) {
        time.value = String(first + Math.floor((at / count) * (last - first)));
        time.dispatchEvent(new Event('input'));
        const now = await frame();
        frames.push(now - before);
        before = now;
      }
      frames.sort((a, b) => a - b);
      return { rate: count * 1000 / frames.reduce((a, b) => a + b), slow: frames[Math.floor(count * 0.95)], clocks: last - first };
    });
    const after = await spent();
    const [script, layout, style] = ['ScriptDuration', 'LayoutDuration', 'RecalcStyleDuration'].map((name) => (after.get(name) - before.get(name)) / 300);
    const size = statSync(join(folder, file)).size;
    const kilobytes = (size / 1000).toFixed(0);
    console.log(`${clocks} clocks: ${kilobytes} kB, shown after ${load.toFixed(0)} ms, ${rate.toFixed(1)} frames/s, 95 % within ${slow.toFixed(1)} ms; of a frame ${script.toFixed(1)} ms are script, ${(layout + style).toFixed(1)} ms layout`);
    await context.close();
  }
}

await (mode === 'measure' ? measure() : check());
