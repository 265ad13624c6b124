//! A window of a wave as WaveJSON, which WaveDrom draws.

use serde_json::json;

use super::window::{Row, Shape, Stretch, Window};

/// Pixels of a cell at `hscale` 1, of a letter of a value, and the greatest `hscale` that is asked for.
const CELL: usize = 40;
const LETTER: usize = 8;
const WIDEST: usize = 10;

impl Window {
    /// The window as WaveJSON, a line for each signal: a character for each cell, `.` where nothing changes, `0`, `1`, `x` and
    /// `z` for bits, `x` and `z` for vectors of such bits alone, and `=` for any other value, which `data` holds as text.
    /// Ticks are clocks; times are a lane of their own, the first, as WaveDrom takes no list of ticks.
    #[must_use]
    pub fn wavedrom(&self) -> String {
        let times = self.by_time.then(|| self.times());
        let rows = || times.iter().chain(&self.rows);
        let lanes: Vec<String> = rows().map(Row::lane).collect();
        let labelled = rows().flat_map(|row| &row.stretches).filter(|stretch| stretch.is_labelled());
        let longest = labelled.map(Stretch::least_cell).max().unwrap_or(1);
        let scale = (longest * LETTER).div_ceil(CELL).clamp(1, WIDEST);
        let lanes = lanes.join(",\n");
        let head = if self.by_time { json!({ "text": self.extent() }) } else { json!({ "tick": self.places.first() }) };
        format!("{{ \"signal\": [\n{lanes}\n],\n\"head\": {head},\n\"config\": {{ \"hscale\": {scale} }} }}\n")
    }

    fn times(&self) -> Row {
        let time = |place: &u64| Stretch { cells: 1, text: place.to_string(), shape: Shape::Known };
        Row { name: self.heading(), stretches: self.places.iter().map(time).collect() }
    }
}

impl Row {
    fn lane(&self) -> String {
        let mut wave = String::new();
        for stretch in &self.stretches {
            wave.push(stretch.letter());
            wave.extend(std::iter::repeat_n('.', stretch.cells - 1));
        }
        let labels = self.stretches.iter().filter(|stretch| stretch.is_labelled());
        let data: Vec<&str> = labels.map(|stretch| stretch.text.as_str()).collect();
        let data = if data.is_empty() { String::new() } else { format!(", \"data\": {}", json!(data)) };
        format!("  {{ \"name\": {}, \"wave\": \"{wave}\"{data} }}", json!(self.name))
    }
}

impl Stretch {
    fn letter(&self) -> char {
        match self.shape {
            Shape::Low => '0',
            Shape::High => '1',
            Shape::Unknown => 'x',
            Shape::Floating => 'z',
            Shape::Known | Shape::Mixed => '=',
        }
    }

    /// The letter takes a text of `data`.
    fn is_labelled(&self) -> bool {
        matches!(self.shape, Shape::Known | Shape::Mixed)
    }
}
