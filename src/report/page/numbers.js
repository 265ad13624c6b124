// Values of signals as numbers and as text: the same numbers as in the step table and in a VCD.

/** A signal: a name for a net, or for several that make up a word of more than 64 bits. */
class Signal {
  constructor(run, { scopes, name, width, reading, drawn, role, states, nets }) {
    Object.assign(this, { run, scopes, name, width, reading, drawn, role });
    this.path = [...scopes, name].join('.');
    this.states = states.length ? new Map(states) : null;
    this.nets = nets.map((net) => run.nets[net]);
    this.radix = null;
    this.texts = new Map();
  }

  /** The clocks of its changes. */
  get clocks() {
    if (this.nets.length === 1) return this.nets[0].clocks;
    if (!this.union) {
      const all = new Set();
      this.nets.forEach((net) => net.clocks.forEach((clock) => all.add(clock)));
      this.union = Float64Array.from(all).sort();
    }
    return this.union;
  }

  /** Its bits after a clock, as an unsigned number; a BigInt of more than 32 bits. */
  bits(clock) {
    if (this.nets.length === 1) return this.nets[0].at(clock);
    return this.nets.reduce((word, net, part) => word | (BigInt(net.at(clock)) << BigInt(64 * part)), 0n);
  }

  /** Its bits after its change number `index`. */
  bitsAt(index) {
    if (this.nets.length === 1) return this.nets[0].values[index];
    return this.bits(this.clocks[index]);
  }

  /** The number that it is declared to mean. */
  number(bits) {
    if (this.reading === 'signed') return signedOf(bits, this.width);
    if (this.reading === 'decimal') return decimalOf(bits, this.width);
    return bits;
  }

  /** The text of bits, in the numbers that are chosen. */
  text(bits, radix) {
    switch (this.radix ?? radix) {
      case 'unsigned': return String(bits);
      case 'signed': return String(signedOf(bits, this.width));
      case 'binary': return bits.toString(2).padStart(this.width, '0');
      case 'hex': return bits.toString(16).padStart(Math.ceil(this.width / 4), '0');
      default:
    }
    const state = this.states?.get(String(bits));
    if (state !== undefined) return state;
    if (this.drawn === 'binary') return bits.toString(2).padStart(this.width, '0');
    return String(this.number(bits));
  }
}

/** The greatest of numbers of things; 0 of none. */
function greatest(things, number) {
  return things.reduce((most, thing) => Math.max(most, number(thing)), 0);
}

/** Bits as two's complement. */
function signedOf(bits, width) {
  if (typeof bits === 'bigint') return BigInt.asIntN(width, bits);
  return (bits << (32 - width)) >> (32 - width);
}

/** Bits as decimal digits of four bits each; a digit beyond 9 counts as what it holds. */
function decimalOf(bits, width) {
  let number = 0n;
  const word = BigInt(bits);
  for (let digit = Math.ceil(width / 4) - 1; digit >= 0; digit--) number = 10n * number + ((word >> BigInt(4 * digit)) & 15n);
  return number;
}

/** A number with a minus sign, and groups of three digits from five digits on. */
function shown(number) {
  const text = String(number).replace(/^-/, '\u2212');
  return text.replace(/\d{5,}/, (digits) => digits.replace(/\B(?=(\d{3})+$)/g, '\u202f'));
}

/** A real number in a few digits. */
function real(number, digits = 3) {
  return Number.isInteger(number) ? shown(number) : number.toFixed(digits).replace(/^-/, '\u2212');
}

/** Time in s as text, in the unit that fits. */
function timeText(seconds) {
  if (seconds === 0) return '0 s';
  const units = [[1, 's'], [1e-3, 'ms'], [1e-6, 'µs'], [1e-9, 'ns'], [1e-12, 'ps']];
  const [size, unit] = units.find(([size]) => seconds >= size * 0.9995) ?? units[4];
  return `${Number((seconds / size).toPrecision(6))} ${unit}`;
}

/** A place as text. */
function placeText(place) {
  return `(${place.map(shown).join(', ')})`;
}
