//! A symbol as shapes: boxes with rows, operators in a circle, flags of ports.

use stepwave_netlist::Net;
use stepwave_netlist::cells::Format;

use crate::draft::{Draft, Kind, Role, Row, Value};
use crate::figure::{Figure, Font, Shape, Style, even, width};
use crate::fold::Fold;

/// Height of a row of a box, and of its title.
const ROW: i32 = 16;
/// Pixels between a frame and what is in it.
const MARGIN: i32 = 8;
/// From the line of a text to the middle of its letters.
const BASE: i32 = 4;
/// Height of an operator.
const ROUND: i32 = 30;
/// Longest row, in characters; a longer one is broken.
const LONGEST: usize = 44;

/// What a symbol has to know of all of them.
pub(crate) struct Context<'c> {
    pub(crate) fold: &'c Fold<'c>,
    /// How a net is written.
    pub(crate) name: &'c dyn Fn(Net) -> Option<String>,
    /// A net has a wire to its readers, and is not only named there.
    pub(crate) is_wired: &'c dyn Fn(Net) -> bool,
}

/// A row as it is written, with the nets that enter there.
struct Line {
    text: String,
    net: Option<Net>,
    /// It begins a row of the box, and is not the rest of one.
    begins: bool,
}

impl Line {
    fn indent(&self) -> i32 {
        if self.begins { 0 } else { 12 }
    }
}

impl Context<'_> {
    /// The shapes of a symbol; none of one that is drawn with another.
    pub(crate) fn figure(&self, draft: &Draft) -> Figure {
        let figure = match draft.kind {
            Kind::Input => self.input(draft.outputs[0]),
            Kind::Operator => self.operator(draft),
            _ => self.boxed(draft),
        };
        figure.reached()
    }

    /// The nets in a symbol that have no name: each has a number in a circle.
    fn lines(&self, draft: &Draft) -> Vec<Line> {
        let mut numbered: Vec<Net> = Vec::new();
        let mut pinned: Vec<Net> = Vec::new();
        let mut lines = Vec::new();
        for row in &draft.rows {
            let text = self.row(row, draft, &mut numbered);
            let mut wired: Vec<Net> = row.nets().into_iter().filter(|&net| (self.is_wired)(net)).collect();
            wired.dedup();
            let net = match (&row.value, wired.as_slice()) {
                (Value::Wire(net, _), _) if (self.is_wired)(*net) => Some(*net),
                (Value::Text(_), [net]) if !pinned.contains(net) => Some(*net),
                _ => None,
            };
            pinned.extend(net);
            let mut parts = broken(&text).into_iter();
            lines.push(Line { text: parts.next().unwrap_or_default(), net, begins: true });
            lines.extend(parts.map(|text| Line { text, net: None, begins: false }));
        }
        // Nets that only conditions and formulas read.
        for net in draft.rows.iter().flat_map(Row::nets).filter(|&net| (self.is_wired)(net)) {
            if !pinned.contains(&net) {
                pinned.push(net);
                lines.push(Line { text: self.called(net, &mut numbered), net: Some(net), begins: true });
            }
        }
        lines
    }

    fn called(&self, net: Net, numbered: &mut Vec<Net>) -> String {
        (self.name)(net).unwrap_or_else(|| {
            let at = numbered.iter().position(|&other| other == net).unwrap_or_else(|| {
                numbered.push(net);
                numbered.len() - 1
            });
            let circled = u32::try_from(at).ok().filter(|&at| at < 20).and_then(|at| char::from_u32(0x2460 + at));
            circled.map_or_else(|| format!("({})", at + 1), String::from)
        })
    }

    /// A row as text: `condition: value`, or the condition alone where the value is a wire.
    fn row(&self, row: &Row, draft: &Draft, numbered: &mut Vec<Net>) -> String {
        let is_only = draft.rows.len() == 1;
        let value = match &row.value {
            Value::Wire(net, bits) if (self.is_wired)(*net) => bits.clone(),
            Value::Wire(net, bits) => format!("{}{bits}", self.called(*net, numbered)),
            Value::Text(formula) => formula.written(|net| self.called(net, numbered)),
        };
        let condition = row.condition.as_ref().map(|formula| formula.written(|net| self.called(net, numbered)));
        if let Some(role) = row.role {
            let condition = condition.map_or_else(String::new, |condition| format!(" if {condition}"));
            let value = if value.is_empty() { value } else { format!(": {value}") };
            return called(role, draft) + &condition + &value;
        }
        match (condition, value.is_empty()) {
            (Some(condition), true) => condition,
            (Some(condition), false) => format!("{condition}: {value}"),
            (None, true) if is_only => "d".to_owned(),
            (None, true) => "else".to_owned(),
            (None, false) if is_only => value,
            (None, false) => format!("else: {value}"),
        }
    }

    fn boxed(&self, draft: &Draft) -> Figure {
        let mut lines = self.lines(draft);
        let title = match (draft.kind, draft.outputs.first()) {
            (Kind::Memory, _) => draft.sign.clone(),
            (_, Some(&net)) => self.title(net),
            (_, None) => String::new(),
        };
        let note = self.note(draft);
        let has_head = !title.is_empty() || !note.is_empty();
        if draft.kind == Kind::Memory {
            self.memory(draft, &mut lines);
        }
        let gap = if title.is_empty() || note.is_empty() { 0 } else { 14 };
        let head = width(&title, false) + gap + width(&note, true);
        let inner = lines.iter().map(|line| width(&line.text, false) + line.indent()).fold(head, i32::max);
        let clock = if draft.kind == Kind::Register { 10 } else { 0 };
        let wide = even(inner + 2 * MARGIN + clock);
        let top = if has_head { ROW + 4 } else { 0 };
        let count = crate::figure::pixels(lines.len());
        let high = (top + ROW * count + 4).max(ROW + 6);
        let mut figure = Figure { size: [wide, high], holds: draft.kind == Kind::Register, ..Figure::default() };
        let style = match draft.kind {
            Kind::Register => Style::Register,
            Kind::Choice => Style::Choice,
            Kind::Memory => Style::Memory,
            _ => Style::Logic,
        };
        let (cells, flags) = (draft.cells.clone(), draft.flags.clone());
        figure.shapes.push(Shape::Frame { at: [0, 0, wide, high], style, cells, flags });
        figure.text([MARGIN, ROW - 3], Font::Title, title);
        figure.text([wide - MARGIN - width(&note, true), ROW - 3], Font::Small, note);
        for (at, line) in lines.iter().enumerate() {
            let y = top + ROW * crate::figure::pixels(at) + ROW / 2 + 2;
            figure.text([MARGIN + line.indent(), y + BASE], Font::Text, line.text.clone());
            figure.left.extend(line.net.map(|net| (net, y)));
        }
        if draft.kind == Kind::Register {
            figure.shapes.push(Shape::Clock { at: [wide, high - 8] });
        }
        let out = if has_head { ROW / 2 + 2 } else { high / 2 / 2 * 2 };
        for (at, &net) in draft.outputs.iter().enumerate() {
            self.stub(&mut figure, net, out + 26 * crate::figure::pixels(at), wide);
        }
        figure.size[1] = figure.size[1].max(out + 12);
        figure
    }

    /// A box as high as its outputs need.
    fn memory(&self, draft: &Draft, lines: &mut Vec<Line>) {
        while lines.len() * 2 < draft.outputs.len() * 3 {
            lines.push(Line { text: String::new(), net: None, begins: true });
        }
    }

    fn title(&self, net: Net) -> String {
        self.fold.named(net).map_or_else(String::new, |_| {
            let full = (self.name)(net).unwrap_or_default();
            full.rsplit('.').next().unwrap_or_default().to_owned()
        })
    }

    /// What is said of a box at the right of its title.
    fn note(&self, draft: &Draft) -> String {
        let net = draft.outputs.first().copied();
        match (draft.kind, net) {
            (Kind::Register, Some(net)) => {
                let bits = self.fold.width(net);
                let format = self.fold.named(net).map(|named| &named.format);
                let reading = match format {
                    Some(Format::Decimal) => " decimal",
                    Some(format) if format.is_signed() => " signed",
                    _ => "",
                };
                format!("{bits} bit{}{reading}", if bits == 1 { "" } else { "s" })
            }
            (Kind::Choice, _) => "MUX".to_owned(),
            (Kind::Memory, _) => {
                let memory = self.fold.netlist.memories.iter().find(|memory| memory.name == draft.sign);
                memory.map_or_else(String::new, |memory| format!("{} × {} bits", memory.size, memory.width.get()))
            }
            _ => String::new(),
        }
    }

    /// An operator: its sign, its operands at the left, its name above.
    fn operator(&self, draft: &Draft) -> Figure {
        let wires: Vec<(Net, &str)> = draft
            .rows
            .iter()
            .filter_map(|row| match &row.value {
                Value::Wire(net, bits) => Some((*net, bits.as_str())),
                Value::Text(_) => None,
            })
            .collect();
        let texts = draft.rows.iter().filter_map(|row| match &row.value {
            Value::Text(formula) => Some(formula.written(|net| (self.name)(net).unwrap_or_default())),
            Value::Wire(..) => None,
        });
        let constants: Vec<String> = texts.collect();
        let sign = match (draft.rows.first().map(|row| &row.value), constants.first()) {
            (Some(Value::Text(_)), Some(constant)) => format!("{constant} {}", draft.sign),
            (_, Some(constant)) => format!("{} {constant}", draft.sign),
            (_, None) => draft.sign.clone(),
        };
        // Nets that are only named where they are read are written in the symbol.
        let label = |(net, bits): &(Net, &str)| match (self.is_wired)(*net) {
            true => (*bits).to_owned(),
            false => format!("{}{bits}", (self.name)(*net).unwrap_or_default()),
        };
        let labels: Vec<String> = wires.iter().map(label).collect();
        let name = draft.outputs.first().map_or_else(String::new, |&net| self.title(net));
        // The width of the upper of two outputs is above its wire.
        let caption = match draft.outputs.len() {
            _ if name.is_empty() => 0,
            0 | 1 => 14,
            _ => 22,
        };
        let labels_wide = labels.iter().map(|label| width(label, true)).max().unwrap_or(0);
        let wide = even((labels_wide + if labels_wide > 0 { 6 } else { 0 } + width(&sign, false) + 2 * 9).max(ROUND));
        let high = ROUND.max(16 * crate::figure::pixels(wires.len().max(draft.outputs.len())));
        let mut figure = Figure { size: [even(wide.max(width(&name, false))), caption + high], ..Figure::default() };
        let (cells, flags) = (draft.cells.clone(), draft.flags.clone());
        figure.shapes.push(Shape::Frame { at: [0, caption, wide, high], style: Style::Operator, cells, flags });
        figure.text([0, 10], Font::Title, name);
        let middle = labels_wide + if labels_wide > 0 { 6 } else { 0 };
        figure.shapes.push(Shape::Sign { at: [i32::midpoint(middle, wide), caption + high / 2 + BASE], text: sign });
        let heights: &[i32] = if wires.len() == 1 { &[15] } else { &[7, 23] };
        for ((&(net, _), label), &y) in wires.iter().zip(&labels).zip(heights) {
            let y = even(caption + y);
            figure.text([6, y + 3], Font::Small, label.clone());
            if (self.is_wired)(net) {
                figure.left.push((net, y));
            }
        }
        for (at, &net) in draft.outputs.iter().enumerate() {
            let alone = draft.outputs.len() == 1;
            let y = even(caption + if alone { high / 2 - 1 } else { 4 + 24 * crate::figure::pixels(at) });
            self.stub(&mut figure, net, y, wide);
        }
        if draft.sign == "±" {
            // It is the sum or the difference: no net has its value.
            figure.shapes.retain(|shape| !matches!(shape, Shape::Text { font: Font::Value, .. }));
        }
        let low = figure.right.iter().map(|&(_, y)| y + 12).max().unwrap_or(0);
        figure.size[1] = even(figure.size[1].max(low));
        figure
    }

    /// A port of the whole drawing, at its left.
    fn input(&self, net: Net) -> Figure {
        let name = self.title(net);
        let wide = even(width(&name, false) + 2 * MARGIN);
        let mut figure = Figure { size: [wide, 24], ..Figure::default() };
        let (cells, flags) = (vec![net], Vec::new());
        figure.shapes.push(Shape::Frame { at: [0, 2, wide, 20], style: Style::Port, cells, flags });
        figure.text([MARGIN, 16], Font::Text, name);
        self.stub(&mut figure, net, 12, wide);
        figure
    }

    /// The beginning of a wire at the right of a symbol: how many bits it has, and room for its value.
    pub(crate) fn stub(&self, figure: &mut Figure, net: Net, y: i32, from: i32) {
        let bits = self.fold.width(net);
        let count = bits.to_string();
        let long = even(14 + width(&count, true).max(width(&"0".repeat(self.digits(net)), true)));
        let to = even(figure.size[0].max(from + long));
        figure.size[0] = to;
        let is_wired = (self.is_wired)(net);
        let end = if is_wired { to } else { from + long };
        let lines = vec![[from, y, end, y]];
        figure.shapes.push(Shape::Wire { net, bits, lines, dots: Vec::new(), ends: Vec::new() });
        if bits > 1 {
            figure.shapes.push(Shape::Slash { at: [from + 7, y] });
            figure.text([from + 11, y - 3], Font::Small, count);
        }
        let text = String::new();
        figure.shapes.push(Shape::Text { at: [from + 6, y + 10], font: Font::Value, text, net: Some(net) });
        if is_wired {
            figure.right.push((net, y));
        }
    }

    /// Characters of the longest value of a net.
    fn digits(&self, net: Net) -> usize {
        let bits = self.fold.width(net) as usize;
        match self.fold.named(net).map(|named| &named.format) {
            Some(Format::States(names)) => names.iter().map(|state| state.1.chars().count()).max().unwrap_or(1),
            Some(format) if format.is_signed() => bits * 30103 / 100_000 + 2,
            _ => bits * 30103 / 100_000 + 1,
        }
    }
}

/// A text in lines of at most about the longest length, broken after operators.
fn broken(text: &str) -> Vec<String> {
    let (mut lines, mut line) = (Vec::new(), String::new());
    for word in text.split_inclusive(' ') {
        let length = line.chars().count() + word.trim_end().chars().count();
        if !line.is_empty() && length > LONGEST {
            lines.push(std::mem::take(&mut line).trim_end().to_owned());
        }
        line.push_str(word);
    }
    lines.push(line.trim_end().to_owned());
    lines
}

/// A port of a memory; of several of its kind with its number, of those that are read in the order of the outputs.
fn called(role: Role, draft: &Draft) -> String {
    let writes = draft.rows.iter().filter(|row| matches!(row.role, Some(Role::Data(_)))).count();
    let (word, number, of, what) = match role {
        Role::Data(number) => ("write", number, writes, "data"),
        Role::Written(number) => ("write", number, writes, "address"),
        Role::Read(number) => ("read", number, draft.outputs.len(), "address"),
    };
    if of > 1 { format!("{word} {} {what}", number + 1) } else { format!("{word} {what}") }
}
