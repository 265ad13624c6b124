// The data of a page: runs, packed as docs/page.md describes, unpacked when they are first shown.

/** Bytes of a text in base 64. */
function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let at = 0; at < binary.length; at++) bytes[at] = binary.charCodeAt(at);
  return bytes;
}

/** Reads what a script element of a run holds: its description and its streams. */
async function unpacked(element) {
  const packed = new Blob([bytesOf(element.textContent.trim())]);
  const stream = packed.stream().pipeThrough(new DecompressionStream('deflate'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  element.textContent = '';
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const meta = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  const streams = bytes.subarray(4 + length);
  const stream_of = (index) => streams.subarray(index ? meta.ends[index - 1] : 0, meta.ends[index]);
  return new Run(meta, stream_of);
}

/** Numbers in a stream: the bytes that end one have their highest bit clear. */
function countOf(bytes) {
  let count = 0;
  for (let at = 0; at < bytes.length; at++) count += 1 - (bytes[at] >> 7);
  return count;
}

/** Sums of unsigned numbers of a stream, from a first number on: clocks from the clocks between them. */
function sumsOf(bytes, from, most) {
  const count = countOf(bytes);
  const sums = most < 2 ** 32 ? new Uint32Array(count) : new Float64Array(count);
  let sum = from;
  for (let at = 0, index = 0; index < count; index++) {
    let number = 0, factor = 1, byte;
    do {
      byte = bytes[at++];
      number += (byte & 127) * factor;
      factor *= 128;
    } while (byte & 128);
    sum += number;
    sums[index] = sum;
  }
  return sums;
}

/** Signed numbers of a stream. */
function numbersOf(bytes, count) {
  const sums = signedSums(bytes, new Int32Array(count), -1);
  for (let at = count - 1; at > 0; at--) sums[at] -= sums[at - 1];
  return sums;
}

/** Sums of signed numbers of a stream that stay within 32 bits, modulo 2^32 where they are not signed. */
function signedSums(bytes, sums, mask) {
  let sum = 0;
  for (let at = 0, index = 0; index < sums.length; index++) {
    let number = 0, shift = 0, byte;
    do {
      byte = bytes[at++];
      number |= (byte & 127) << shift;
      shift += 7;
    } while (byte & 128);
    if (byte & 64 && shift < 32) number |= -1 << shift;
    sum = (sum + number) & mask;
    sums[index] = sum;
  }
  return sums;
}

/** Sums of these once more. */
function sumAgain(sums, mask) {
  for (let sum = 0, index = 0; index < sums.length; index++) sums[index] = sum = (sum + sums[index]) & mask;
}

/** The same of a net of more than 32 bits: sums of sums as often as the order says. */
function wideSums(bytes, count, width, order) {
  const sums = new BigUint64Array(count);
  const totals = new BigUint64Array(order);
  for (let at = 0, index = 0; index < count; index++) {
    let number = 0n, shift = 0n, byte;
    do {
      byte = bytes[at++];
      number |= BigInt(byte & 127) << shift;
      shift += 7n;
    } while (byte & 128);
    if (byte & 64) number -= 1n << shift;
    // Elements of the array count modulo 2^64.
    for (let level = 0; level < order; level++) {
      totals[level] += number;
      number = totals[level];
    }
    sums[index] = BigInt.asUintN(width, number);
  }
  return sums;
}

/** Index of the last of ascending numbers that is not above another; -1 before the first. */
function lastUpTo(numbers, limit, from = -1) {
  let low = from, high = numbers.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (numbers[middle] <= limit) low = middle; else high = middle;
  }
  return low;
}

/** The same from a near index on: doubling steps, then halves. */
function lastUpToNear(numbers, limit, from) {
  let step = 1;
  while (from + step < numbers.length && numbers[from + step] <= limit) {
    from += step;
    step *= 2;
  }
  let low = from, high = Math.min(numbers.length, from + step);
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (numbers[middle] <= limit) low = middle; else high = middle;
  }
  return low;
}

/** A net: the clocks of its changes, and its values. */
class Net {
  constructor(run, [index, width, times, values, order]) {
    Object.assign(this, { run, index, width, times, stream: values, order });
  }

  // Decoded when they are first asked for; the values then take the place of these two.
  get clocks() {
    return this.decode().clocks;
  }

  get values() {
    return this.decode().values;
  }

  decode() {
    const { run, width, order } = this;
    const clocks = sumsOf(run.stream(this.times), run.first, run.last);
    const bytes = run.stream(this.stream);
    let values;
    if (width === 1) {
      values = new Uint8Array(clocks.length);
      for (let at = 0, value = bytes[0] & 1; at < values.length; at++, value ^= 1) values[at] = value;
    } else if (width <= 32) {
      const mask = width === 32 ? -1 : 2 ** width - 1;
      values = signedSums(bytes, new Uint32Array(clocks.length), mask);
      for (let again = 1; again < order; again++) sumAgain(values, mask);
    } else {
      values = wideSums(bytes, clocks.length, width, order);
    }
    Object.defineProperty(this, 'clocks', { value: clocks });
    Object.defineProperty(this, 'values', { value: values });
    return this;
  }

  /** The value after a clock. */
  at(clock) {
    return this.values[Math.max(0, lastUpTo(this.clocks, clock))];
  }
}

/** A run: its description, nets, signals, path, rows of the step table and moves. */
class Run {
  constructor(meta, stream) {
    Object.assign(this, meta);
    this.stream = stream;
    this.nets = meta.nets.map((net) => new Net(this, net));
    this.signals = meta.signals.map((signal) => new Signal(this, signal));
    this.byPath = new Map(this.signals.map((signal) => [signal.path, signal]));
    this.byNet = new Map(this.nets.map((net) => [net.index, net]));
    this.moves ??= [];
    this.starts = this.blockStarts();
    if (meta.path) this.readPath(meta.path);
    if (meta.steps) this.readSteps(meta.steps);
  }

  readPath({ start, count, clocks, pulses }) {
    const axes = pulses.map((stream, axis) => {
      const bytes = this.stream(stream);
      const places = new Int32Array(count + 1);
      places[0] = start[axis];
      // A pulse is one byte, with its sign in the second highest bit.
      for (let at = 0; at < count; at++) places[at + 1] = places[at] + ((bytes[at] << 25) >> 25);
      return places;
    });
    this.path = { axes, clocks: sumsOf(this.stream(clocks), 0, this.last) };
  }

  readSteps({ clocks, numbers, blocks, pulses, count }) {
    const inside = (clock) => clock >= this.first && clock <= this.last;
    const all = sumsOf(this.stream(clocks), 0, this.last);
    const from = all.findIndex(inside);
    const end = from < 0 ? 0 : lastUpTo(all, this.last) + 1;
    const cut = (numbers) => numbers.subarray(Math.max(0, from), end);
    const sums = (stream) => cut(signedSums(this.stream(stream), new Int32Array(count), -1));
    const apart = (stream) => cut(numbersOf(this.stream(stream), count));
    this.steps = { clocks: cut(all), numbers: sums(numbers), blocks: sums(blocks), pulses: pulses.map(apart) };
  }

  /** Clocks at which blocks begin: moves of a program, or loads of a curve in several parts. */
  blockStarts() {
    if (this.moves.length) return this.moves.map((move) => move.begun);
    const loaded = this.interpolator && this.nets[this.interpolator.loaded];
    if (!loaded) return [];
    return Array.from(loaded.clocks).filter((_, at) => loaded.values[at] === 1);
  }

  /** Where the tool is after a clock, in BLU. */
  place(clock) {
    if (!this.path) return [];
    const at = lastUpTo(this.path.clocks, clock) + 1;
    return this.path.axes.map((axis) => axis[at]);
  }

  /** Index of the row of the step table that is valid at a clock; -1 before the first. */
  row(clock) {
    return this.steps ? lastUpTo(this.steps.clocks, clock) : -1;
  }

  /** Index of the block that runs at a clock; -1 before the first. */
  block(clock) {
    return lastUpTo(this.starts, clock);
  }
}
