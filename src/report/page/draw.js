// How the rows of the wave, its ruler and its cursor are drawn: what is in view, and no more than a shape a pixel.

/** Width of a character of the wave's font, measured once. */
let charWidth = 0;

Object.assign(WaveView.prototype, {
  drawWaves(context, width, height) {
    if (!this.run || !this.shown) return;
    width = this.surface.width;
    height = this.surface.height;
    const { top } = this;
    context.font = FONT;
    charWidth ||= context.measureText('0').width;
    this.drawTicks(context, width, height);
    for (const item of this.shown) {
      const y = item.top - top;
      if (y + item.height < 0 || y > height) continue;
      if (item === this.selected) {
        context.fillStyle = colours.band;
        context.fillRect(0, y, width, item.height);
      }
      if (!item.signal) continue;
      const { signal } = item;
      const low = y + item.height - 5, high = y + 5;
      if (signal.drawn === 'curve' && this.radixOf(signal) === 'auto') this.drawCurve(context, signal, width, low, high);
      else if (signal.width === 1) this.drawBit(context, signal, width, low, Math.max(high, low - ROW + 10));
      else this.drawBus(context, signal, width, low, high);
    }
  },

  radixOf(signal) {
    return signal.radix ?? this.cursor.radix;
  },

  x(clock) {
    return (clock - this.from) * this.scale;
  },

  drawTicks(context, width, height) {
    const step = tickStep(this.scale, 90, 1);
    context.fillStyle = colours.grid;
    for (let clock = Math.ceil(this.from / step) * step; clock < this.to; clock += step) {
      context.fillRect(Math.round(this.x(clock)), 0, 1, height);
    }
    const { starts } = this.run;
    const [first, end] = [Math.max(0, this.run.block(this.from)), this.run.block(this.to) + 1];
    // Where blocks are shorter than some pixels, their lines would be a grey field.
    if (starts.length < 2 || end - first > width / 10) return;
    context.fillStyle = colours.line;
    for (const start of starts.slice(first, end)) context.fillRect(Math.round(this.x(start)), 0, 1, height);
  },

  /**
   * Goes along the changes in view: `one` takes a value from place to place, `many` places where values take less than some pixels: each pixel, or all
   * of them next to each other where these are joined.
   */
  walk(signal, width, { least, joins }, one, many) {
    const { clocks } = signal;
    const last = clocks.length - 1;
    const short = (at) => at < last && (clocks[at + 1] - clocks[at]) * this.scale < least;
    let at = Math.max(0, lastUpTo(clocks, this.from));
    while (at <= last && clocks[at] < this.to) {
      const from = this.x(clocks[at]);
      if (!short(at)) {
        const to = this.x(at < last ? clocks[at + 1] : this.run.last + 1);
        one(Math.max(from, -4), Math.min(to, width + 4), at);
        at++;
        continue;
      }
      const first = at;
      let end = from;
      do {
        // A pixel on, or where the next change is: never less than one change.
        end = Math.max(Math.floor(end) + 1.5, this.x(clocks[at + 1]));
        at = Math.max(at + 1, lastUpToNear(clocks, this.from + end / this.scale, at));
      } while (joins && end < width && short(at));
      many(Math.max(from, -4), this.x(clocks[at]), first, at);
    }
  },

  drawBit(context, signal, width, low, high) {
    const { values } = signal.nets[0];
    const flag = signal.role === 'flag';
    context.strokeStyle = context.fillStyle = flag ? (values.includes(1) ? colours.bad : colours.muted) : colours.bit;
    context.lineWidth = 1.3;
    context.beginPath();
    const dense = [], filled = [];
    let before = null;
    this.walk(signal, width, { least: 1.5, joins: true }, (from, to, at) => {
      const y = values[at] ? high : low;
      if (before === null) context.moveTo(from, y); else context.lineTo(from, before);
      context.lineTo(from, y);
      context.lineTo(to, y);
      if (values[at]) filled.push([from, to]);
      before = y;
    }, (from, to, _, last) => {
      dense.push([from, to]);
      before = values[last] ? high : low;
      context.moveTo(to, before);
    });
    context.stroke();
    context.globalAlpha = 0.75;
    for (const [from, to] of dense) context.fillRect(from, high, Math.max(1, to - from), low - high);
    context.globalAlpha = flag ? 0.5 : 0.14;
    for (const [from, to] of filled) context.fillRect(from, high, to - from, low - high);
    context.globalAlpha = 1;
  },

  drawBus(context, signal, width, low, high) {
    const { radix } = this.cursor;
    const middle = (low + high) / 2;
    const labels = [];
    context.strokeStyle = colours.bus;
    context.lineWidth = 1.1;
    context.beginPath();
    const dense = [];
    this.walk(signal, width, { least: 4, joins: true }, (from, to, at) => {
      const slope = Math.min(3, (to - from) / 2);
      context.moveTo(from, middle);
      context.lineTo(from + slope, high);
      context.lineTo(to - slope, high);
      context.lineTo(to, middle);
      context.lineTo(to - slope, low);
      context.lineTo(from + slope, low);
      context.closePath();
      if (to - from > charWidth + 5) labels.push([from, to, at]);
    }, (from, to) => dense.push([from, to]));
    context.fillStyle = colours.busfill;
    context.fill();
    context.stroke();
    context.fillStyle = colours.bus;
    context.globalAlpha = 0.55;
    for (const [from, to] of dense) context.fillRect(from, high, Math.max(1, to - from), low - high);
    context.globalAlpha = 1;
    context.fillStyle = colours.ink;
    context.textAlign = 'left';
    context.textBaseline = 'middle';
    for (const [from, to, at] of labels) {
      const [left, right] = [Math.max(from, 0) + 4, Math.min(to, width) - 3];
      const room = Math.floor((right - left) / charWidth);
      const text = signal.text(signal.bitsAt(at), radix);
      if (text.length <= room) context.fillText(text, left, middle + 0.5);
      else if (room > 2) context.fillText(`${text.slice(0, room - 1)}…`, left, middle + 0.5);
    }
    context.textBaseline = 'alphabetic';
  },

  drawCurve(context, signal, width, low, high) {
    const heights = heightsOf(signal);
    const { least, greatest } = heights;
    const y = (number) => low - ((number - least) / Math.max(greatest - least, 1)) * (low - high);
    if (least < 0 && greatest > 0) {
      context.fillStyle = colours.line;
      context.fillRect(0, Math.round(y(0)), width, 1);
    }
    context.strokeStyle = colours.curve;
    context.lineWidth = 1.4;
    context.beginPath();
    let started = false;
    this.walk(signal, width, { least: 1.5, joins: false }, (from, to, at) => {
      const place = y(heights.number(at));
      if (started) context.lineTo(from, place); else context.moveTo(from, place);
      context.lineTo(to, place);
      started = true;
    }, (from, to, first, last) => {
      const [bottom, top] = heights.range(first, last);
      if (!started) context.moveTo(from, y(heights.number(first)));
      context.lineTo(from, y(bottom));
      context.lineTo(from, y(top));
      context.lineTo(to, y(heights.number(last)));
      started = true;
    });
    context.stroke();
    context.fillStyle = colours.muted;
    context.font = '10px ui-monospace, monospace';
    context.textAlign = 'right';
    context.fillText(shown(greatest), width - 4, high + 8);
    context.fillText(shown(least), width - 4, low - 1);
    context.font = FONT;
  },

  drawCursor() {
    if (!this.run || !this.surface.width) return;
    const text = shown(this.cursor.clock);
    const x = this.x(this.cursor.clock);
    this.line.style.transform = `translateX(${Math.round(x)}px)`;
    const width = `${Math.max(this.scale, 1.5)}px`;
    if (this.line.style.width !== width) this.line.style.width = width;
    // 7 pixels a digit, and its frame.
    const right = this.surface.width - text.length * 7 - 12;
    this.label.style.transform = `translateX(${Math.round(Math.max(0, Math.min(right, x)))}px)`;
    setText(this.label, text);
  },

  drawRuler(context) {
    if (!this.run) return;
    const { width, height } = this.ruler;
    const step = tickStep(this.scale, 90, 1);
    context.font = '11px ui-monospace, monospace';
    context.fillStyle = colours.muted;
    context.textAlign = 'left';
    for (let clock = Math.ceil(this.from / step) * step; clock < this.to; clock += step) {
      const x = Math.round(this.x(clock));
      context.fillRect(x, height - 7, 1, 7);
      context.fillText(shown(clock), x + 4, height - 5);
    }
    for (const event of this.run.events) {
      const x = this.x(event.clock);
      if (x < -8 || x > width + 8) continue;
      context.fillStyle = colours.bad;
      context.beginPath();
      context.moveTo(x, height);
      context.lineTo(x - 5, height - 9);
      context.lineTo(x + 5, height - 9);
      context.fill();
    }
  },
});

/** Numbers of a signal as heights, with the least and greatest of every 64 changes. */
function heightsOf(signal) {
  if (signal.heights) return signal.heights;
  const count = signal.clocks.length;
  const number = (at) => Number(signal.number(signal.bitsAt(at)));
  const pieces = [];
  for (let from = 0; from < count; from += 64) {
    let [least, greatest] = [Infinity, -Infinity];
    for (let at = from; at < Math.min(count, from + 64); at++) {
      const value = number(at);
      least = Math.min(least, value);
      greatest = Math.max(greatest, value);
    }
    pieces.push([least, greatest]);
  }
  const joined = (ranges) => ranges.reduce((a, b) => [Math.min(a[0], b[0]), Math.max(a[1], b[1])], [Infinity, -Infinity]);
  const range = (first, last) => {
    const within = [];
    for (let at = first; at <= last;) {
      if (at % 64 === 0 && at + 64 <= last) {
        within.push(pieces[at / 64]);
        at += 64;
      } else {
        const value = number(at++);
        within.push([value, value]);
      }
    }
    return joined(within);
  };
  const [least, greatest] = joined(pieces);
  signal.heights = { number, range, least, greatest };
  return signal.heights;
}
