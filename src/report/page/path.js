// The path: the ideal curve, the pulses of the tool, and where it is at the cursor.

/** Points in a piece of the path whose bounds are known. */
const PIECE = 512;
/** Colours of the paths of other methods, readable on a light and on a dark ground. */
const OTHERS = ['#1f9e89', '#d9713c', '#8d6bc4', '#a98600', '#4a86b8', '#c8506b', '#6f9a2d', '#8a7f78'];

class PathView {
  constructor(cursor) {
    this.cursor = cursor;
    /** Other methods that are drawn too: name and run. */
    this.others = [];
    this.element = $('path');
    this.surface = new Surface(this.element, [(context) => this.drawBase(context), (context) => this.drawTravelled(context)]);
    // No part of a drawing, so that a move of it draws nothing anew.
    this.tool = make('div', { className: 'tool' });
    this.element.append(this.tool);
    this.surface.resized = () => this.fitted && this.fit();
    gestures(this.element, {
      drag: ([dx, dy]) => this.pan(dx, dy),
      pan: ([dx, dy]) => this.pan(dx, dy),
      zoom: (factor, at) => this.zoom(factor, at),
      tap: (at) => this.pick(at),
      wheel: (event, at) => {
        event.preventDefault();
        this.zoom(wheelFactor(event), at);
      },
    });
    const plane = make('select', { id: 'plane', data: { title: 'plane' }, onchange: () => {
      this.plane = this.planes[Number(plane.value)];
      this.project();
    } });
    $('path-tools').append(
      plane,
      button('zoom_in', '', () => this.zoom(1.5)), button('zoom_out', '', () => this.zoom(1 / 1.5)), button('fit', '', () => this.fit()),
    );
  }

  /** Takes another run. */
  show(run) {
    this.run = run;
    $('path-panel').hidden = !run.path;
    if (!run.path) return;
    this.choosePlanes();
    this.project();
  }

  /** Draws these runs of other methods too. */
  overlay(others) {
    this.others = others.filter(({ run }) => run !== this.run && run.path)
      .map((other, index) => ({ ...other, colour: OTHERS[index % OTHERS.length] }));
    if (!this.run?.path) return;
    this.legend();
    this.surface.redraw();
  }

  /** The planes of x, y and z that there are. */
  choosePlanes() {
    const axes = this.run.interpolator.axes.slice(0, 3);
    const planes = axes.flatMap((right, a) => axes.slice(a + 1).map((up, b) => [a, a + 1 + b, `${right}${up}`.toUpperCase()]));
    this.planes = planes.length ? planes : [[0, 1, '']];
    this.plane = this.planes[0];
    const choice = $('plane');
    choice.hidden = planes.length < 2;
    choice.replaceChildren(...planes.map(([, , name], index) => make('option', { value: String(index), textContent: name })));
  }

  /** Takes the coordinates of the plane. */
  project() {
    const { run, plane: [right, up] } = this;
    const { axes } = run.path;
    const [xs, ys] = [axes[right], axes[up] ?? new Int32Array(axes[right].length)];
    Object.assign(this, { xs, ys });
    // Of some curves the outline is known in x and y alone.
    const flat = (points) => points.filter((point) => point[right] !== undefined && (point[up] !== undefined || !axes[up]))
      .map((point) => [point[right], point[up] ?? 0]);
    const outlines = run.moves.length ? run.moves.filter((move) => move.kind !== 'rapid').map((move) => move.outline) : [run.outline];
    this.outlines = outlines.map(flat);
    this.pieces = [];
    for (let from = 0; from < xs.length; from += PIECE) this.pieces.push(boundsOf(xs, ys, from, Math.min(xs.length, from + PIECE + 1)));
    const joined = (a, b) => [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
    const whole = this.pieces.reduce(joined);
    this.bounds = this.outlines.reduce((all, points) => points.reduce((all, [x, y]) => joined(all, [x, y, x, y]), all), whole);
    this.rapids = run.moves.map((move) => move.kind === 'rapid');
    this.legend();
    this.fit();
  }

  legend() {
    const kinds = ['ideal', 'pulses', ...(this.rapids.some(Boolean) ? ['rapid'] : []), 'tool', ...(worstOf(this.run) ? ['worst'] : [])];
    const items = kinds.map((kind) => make('li', { className: kind }, make('span', { data: { word: kind }, textContent: word(kind) })));
    const others = this.others.map(({ name, colour }) => {
      const item = make('li', { className: 'other' }, make('span', { textContent: name }));
      item.style.setProperty('--accent', colour);
      return item;
    });
    $('legend').replaceChildren(...items, ...others);
  }

  fit() {
    const { width, height } = this.surface;
    if (!this.run?.path || !width) return;
    const [left, low, right, high] = this.bounds;
    const margin = 30;
    const scale = Math.min((width - 2 * margin - 16) / Math.max(right - left, 1), (height - 2 * margin) / Math.max(high - low, 1), 60);
    this.scale = Math.max(scale, 1e-7);
    this.origin = [width / 2 + 8 - this.scale * (left + right) / 2, height / 2 - 6 + this.scale * (low + high) / 2];
    this.fitted = true;
    this.changed();
  }

  pan(dx, dy) {
    this.origin = [this.origin[0] + dx, this.origin[1] + dy];
    this.fitted = false;
    this.changed();
  }

  zoom(factor, [x, y] = [this.surface.width / 2, this.surface.height / 2]) {
    const scale = Math.min(400, Math.max(1e-7, this.scale * factor));
    const by = scale / this.scale;
    this.origin = [x + (this.origin[0] - x) * by, y + (this.origin[1] - y) * by];
    this.scale = scale;
    this.fitted = false;
    this.changed();
  }

  changed() {
    this.line = null;
    this.surface.redraw();
  }

  /** The cursor has moved: what lies between is added to what is drawn, or taken from it. */
  moved() {
    if (!this.run?.path || !this.scale) return;
    const point = lastUpTo(this.run.path.clocks, this.cursor.clock) + 1;
    this.placeTool(point);
    const [, layer] = this.surface.layers;
    if (layer.stale || this.travelled === undefined) return;
    const before = this.travelled;
    this.travelled = point;
    if (point > before) this.drawFrom(layer.context, before, point);
    else if (point < before) this.withdraw(layer.context, before, point);
  }

  placeTool(point) {
    const [x, y] = [this.origin[0] + this.xs[point] * this.scale, this.origin[1] - this.ys[point] * this.scale];
    this.tool.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }

  /** The index in what is visible of the last point up to this one. */
  seenUpTo(point) {
    const { at } = this.visible();
    let [low, high] = [0, at.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((at[middle] < 0 ? -1 - at[middle] : at[middle]) <= point) low = middle + 1; else high = middle;
    }
    return low - 1;
  }

  /** Clears what was travelled between two points, and draws what else is there. */
  withdraw(context, before, point) {
    const { x, y } = this.visible();
    const [first, last] = [Math.max(0, this.seenUpTo(point)), this.seenUpTo(before)];
    const [left, low, right, high] = boundsOf(x, y, first, last + 1);
    if (left > right) return;
    const box = [left - 4, low - 4, right - left + 8, high - low + 8];
    context.save();
    context.beginPath();
    context.rect(...box);
    context.clip();
    context.clearRect(...box);
    this.drawFrom(context, -1, point);
    context.restore();
  }

  /** Sets the cursor to where the tool is nearest to a place. */
  pick([px, py]) {
    const [x, y] = [(px - this.origin[0]) / this.scale, (this.origin[1] - py) / this.scale];
    const { xs, ys } = this;
    let best = Infinity, found = 0;
    this.pieces.forEach(([left, low, right, high], piece) => {
      const apart = Math.hypot(Math.max(left - x, 0, x - right), Math.max(low - y, 0, y - high));
      if (apart >= best) return;
      for (let at = piece * PIECE; at < Math.min(xs.length, (piece + 1) * PIECE); at++) {
        const distance = Math.hypot(xs[at] - x, ys[at] - y);
        if (distance < best) [best, found] = [distance, at];
      }
    });
    this.cursor.seek(found ? this.run.path.clocks[found - 1] : this.run.first);
  }

  /** The points that show at this scale: places on the screen, and which point of the path each is; -1 where the line breaks. */
  visible() {
    if (this.line) return this.line;
    const { xs, ys, scale, pieces, surface: { width, height } } = this;
    const [left, top] = this.origin;
    const line = { x: [], y: [], at: [] };
    let lastX = NaN, lastY = NaN, broken = true;
    pieces.forEach((bounds, piece) => {
      const outside = left + bounds[2] * scale < -20 || left + bounds[0] * scale > width + 20
        || top - bounds[1] * scale < -20 || top - bounds[3] * scale > height + 20;
      if (outside) {
        broken = true;
        return;
      }
      const end = Math.min(xs.length, (piece + 1) * PIECE + 1);
      for (let at = piece * PIECE; at < end; at++) {
        const x = left + xs[at] * scale, y = top - ys[at] * scale;
        if (!broken && Math.abs(x - lastX) + Math.abs(y - lastY) < 1 && at !== end - 1) continue;
        line.x.push(x);
        line.y.push(y);
        line.at.push(broken ? -1 - at : at);
        [lastX, lastY, broken] = [x, y, false];
      }
    });
    this.line = line;
    return line;
  }

  /** Draws the path up to a point, from the first one or from another on. */
  stroke(context, upTo, style, width, rapid, from = -1) {
    const { x, y, at } = this.visible();
    const { clocks } = this.run.path;
    context.beginPath();
    let block = -1, isRapid = false;
    const begin = Math.max(0, this.seenUpTo(from));
    for (let index = begin; index < at.length; index++) {
      const point = at[index] < 0 ? -1 - at[index] : at[index];
      if (point > upTo) break;
      if (this.rapids.length) {
        const now = this.run.block(point ? clocks[point - 1] : this.run.first);
        if (now !== block) [block, isRapid] = [now, this.rapids[now] ?? false];
      }
      if (index === begin || at[index] < 0 || isRapid !== rapid) context.moveTo(x[index], y[index]); else context.lineTo(x[index], y[index]);
    }
    context.strokeStyle = style;
    context.lineWidth = width;
    context.setLineDash(rapid ? [5, 4] : []);
    context.stroke();
    context.setLineDash([]);
  }

  drawBase(context) {
    if (!this.run?.path || !this.scale) return;
    const { width, height } = this.surface;
    this.drawGrid(context, width, height);
    context.lineJoin = 'round';
    context.strokeStyle = colours.ideal;
    context.lineWidth = this.scale < 4 ? 4 : 1.6;
    context.globalAlpha = this.scale < 4 ? 0.55 : 1;
    context.beginPath();
    for (const outline of this.outlines) this.trace(context, outline);
    context.stroke();
    context.globalAlpha = 1;
    this.drawOthers(context);
    const all = this.xs.length;
    this.stroke(context, all, colours.pale, 1.6, false);
    if (this.rapids.some(Boolean)) this.stroke(context, all, colours.rapid, 1, true);
    this.drawMarks(context);
  }

  /** The paths of other methods, without points less than a pixel from the one before. */
  drawOthers(context) {
    const { scale, origin: [left, top], plane: [right, up] } = this;
    context.lineWidth = 1.2;
    for (const { run: { path: { axes } }, colour } of this.others) {
      const [xs, ys] = [axes[right], axes[up]];
      if (!xs || !ys) continue;
      context.strokeStyle = colour;
      context.beginPath();
      let [lastX, lastY] = [NaN, NaN];
      for (let at = 0; at < xs.length; at++) {
        const [x, y] = [left + xs[at] * scale, top - ys[at] * scale];
        if (at && at < xs.length - 1 && Math.abs(x - lastX) + Math.abs(y - lastY) < 1) continue;
        if (at) context.lineTo(x, y); else context.moveTo(x, y);
        [lastX, lastY] = [x, y];
      }
      context.stroke();
    }
  }

  /** Adds a line of points to what is drawn, without those less than a pixel apart. */
  trace(context, points) {
    let [lastX, lastY] = [NaN, NaN];
    points.forEach(([px, py], at) => {
      const [x, y] = [this.origin[0] + px * this.scale, this.origin[1] - py * this.scale];
      if (at && at < points.length - 1 && Math.abs(x - lastX) + Math.abs(y - lastY) < 1) return;
      if (at) context.lineTo(x, y); else context.moveTo(x, y);
      [lastX, lastY] = [x, y];
    });
  }

  drawGrid(context, width, height) {
    const { scale, origin: [left, top] } = this;
    const step = tickStep(scale, 56, 1);
    const lines = (every, style) => {
      context.strokeStyle = style;
      context.lineWidth = 1;
      context.beginPath();
      for (let x = Math.ceil(-left / scale / every) * every; left + x * scale <= width; x += every) {
        const at = Math.round(left + x * scale) + 0.5;
        context.moveTo(at, 0);
        context.lineTo(at, height);
      }
      for (let y = Math.ceil((top - height) / scale / every) * every; top - y * scale >= 0; y += every) {
        const at = Math.round(top - y * scale) + 0.5;
        context.moveTo(0, at);
        context.lineTo(width, at);
      }
      context.stroke();
    };
    if (scale >= 9 && step > 1) lines(1, colours.grid);
    lines(step, colours.line);
    context.font = '11px ui-monospace, monospace';
    const label = (text, x, y, align) => {
      context.textAlign = align;
      context.lineWidth = 3;
      context.strokeStyle = colours.panel;
      context.strokeText(text, x, y);
      context.fillStyle = colours.muted;
      context.fillText(text, x, y);
    };
    const [right, up] = this.plane.map((axis) => this.run.interpolator.axes[axis]);
    label(`${right} (BLU)`, width - 6, height - 5, 'right');
    if (up) label(`${up} (BLU)`, 4, 14, 'left');
    for (let x = Math.ceil(-left / scale / step) * step; left + x * scale <= width - 80; x += step) {
      if (left + x * scale > 40) label(shown(x), left + x * scale, height - 5, 'center');
    }
    for (let y = Math.ceil((top - height) / scale / step) * step; top - y * scale >= 26; y += step) {
      if (top - y * scale < height - 18) label(shown(y), 4, top - y * scale + 4, 'left');
    }
  }

  /** Where the tool is after a clock, in the plane. */
  flat(clock) {
    const place = this.run.place(clock);
    return [place[this.plane[0]], place[this.plane[1]] ?? 0];
  }

  /** Start, end, greatest error and overflows. */
  drawMarks(context) {
    const { run, xs, ys } = this;
    const spot = (x, y) => [this.origin[0] + x * this.scale, this.origin[1] - y * this.scale];
    const ring = ([x, y], radius, style, fill) => {
      context.beginPath();
      context.arc(x, y, radius, 0, 7);
      context.lineWidth = 1.8;
      context.strokeStyle = context.fillStyle = style;
      if (fill) context.fill(); else context.stroke();
    };
    ring(spot(xs[0], ys[0]), 3.5, colours.ink, true);
    const end = this.outlines.at(-1)?.at(-1);
    if (end && !run.moves.length) ring(spot(...end), 7, colours.ink, false);
    const worst = worstOf(run);
    if (worst) {
      const [x, y] = spot(...this.flat(worst.clock));
      context.beginPath();
      context.moveTo(x, y - 9);
      context.lineTo(x + 9, y);
      context.lineTo(x, y + 9);
      context.lineTo(x - 9, y);
      context.closePath();
      context.lineWidth = 2;
      context.strokeStyle = colours.cursor;
      context.stroke();
    }
    for (const event of run.events) {
      ring(spot(...this.flat(event.clock)), 8, colours.bad, false);
    }
  }

  drawTravelled(context) {
    if (!this.run?.path || !this.scale) return;
    const point = lastUpTo(this.run.path.clocks, this.cursor.clock) + 1;
    this.travelled = point;
    this.placeTool(point);
    this.drawFrom(context, -1, point);
  }

  /** What the tool travels between two points. */
  drawFrom(context, from, upTo) {
    context.lineJoin = 'round';
    this.stroke(context, upTo, colours.accent, 2.2, false, from);
    if (this.scale < 7) return;
    context.fillStyle = colours.accent;
    const { x, y } = this.visible();
    const last = this.seenUpTo(upTo);
    for (let index = Math.max(0, this.seenUpTo(from)); index <= last; index++) context.fillRect(x[index] - 2, y[index] - 2, 4, 4);
  }
}

/** The least and greatest coordinates of points. */
function boundsOf(xs, ys, from, to) {
  let [left, low, right, high] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let at = from; at < to; at++) {
    left = Math.min(left, xs[at]);
    right = Math.max(right, xs[at]);
    low = Math.min(low, ys[at]);
    high = Math.max(high, ys[at]);
  }
  return [left, low, right, high];
}

/** The greatest path error of a run, as its report gives it, and the clock at which the tool is there. */
function worstOf(run) {
  if (run.worstAt === undefined) run.worstAt = run.moves.length ? worstOfMoves(run) : worstOfCurve(run);
  return run.worstAt;
}

function worstOfCurve(run) {
  const { worst, steps, path } = run;
  if (!worst || !path) return null;
  const row = lastUpTo(steps.numbers, worst.step);
  if (row < 0 || steps.numbers[row] !== worst.step) return null;
  // A step of many pulses may be worse within than where it ends.
  let at = lastUpTo(path.clocks, steps.clocks[row]);
  const end = row + 1 < steps.clocks.length ? steps.clocks[row + 1] : run.last;
  const is = (point) => worst.position.every((coordinate, axis) => path.axes[axis][point + 1] === coordinate);
  while (!is(at)) if (++at >= path.clocks.length || path.clocks[at] > end) return null;
  return { error: worst.error, clock: Math.max(steps.clocks[row], at < 0 ? run.first : path.clocks[at]) };
}

function worstOfMoves(run) {
  const error = (move) => move.path_error.greatest;
  const move = run.moves.reduce((worst, move) => (error(move) > error(worst) ? move : worst));
  if (!(error(move) > 0) || move.worst_clock < run.first || move.worst_clock > run.last) return null;
  return { error: error(move), clock: move.worst_clock, line: move.line };
}
