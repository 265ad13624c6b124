//! The header of a VCD file: scopes, variables, the timescale.

use super::super::limits::MAX_WIDTH;
use super::super::names::Var;
use super::super::store::Changes;
use super::super::{ValueKind, WaveError, timescale};
use super::{Command, Declared, ParserState, Vcd, quoted};

impl Vcd<'_> {
    /// A word of the header.
    pub(super) fn header(&mut self, word: &[u8]) -> Result<(), WaveError> {
        if self.state == ParserState::Header {
            let Some(keyword) = word.strip_prefix(b"$") else {
                let word = quoted(word);
                return Err(self.refused(format!("`{word}` comes before $enddefinitions, which ends the header")));
            };
            self.command = Command { keyword: quoted(keyword), line: self.line, words: Vec::new() };
            self.state = ParserState::Command;
            return Ok(());
        }
        // The last word and $end are sometimes written as one.
        if let Some(last) = word.strip_suffix(b"$end") {
            self.state = ParserState::Header;
            self.push(last)?;
            return self.command();
        }
        self.push(word)
    }

    fn push(&mut self, word: &[u8]) -> Result<(), WaveError> {
        let Command { keyword, line, words } = &mut self.command;
        let prose = ["comment", "date", "version"].contains(&keyword.as_str());
        let next: [&[u8]; 4] = [b"$var", b"$scope", b"$upscope", b"$enddefinitions"];
        if !prose && words.len() > 3 && next.contains(&word) {
            let reason = format!("`{}` where the ${keyword} of line {line} has no $end yet", quoted(word));
            return Err(self.refused(reason));
        }
        // Of comments those are read that name a state.
        let names_state = keyword == "comment" && words.first().map_or(word, |first| first.as_bytes()) == b"state";
        if (!prose || names_state) && !word.is_empty() {
            words.push(String::from_utf8_lossy(word).into_owned());
        }
        Ok(())
    }

    /// A whole command has been read.
    fn command(&mut self) -> Result<(), WaveError> {
        let Command { keyword, words, .. } = std::mem::take(&mut self.command);
        match (keyword.as_str(), words.as_slice()) {
            ("comment", [_, leaf, bits, name @ ..]) if bits.bytes().all(|bit| matches!(bit, b'0' | b'1')) => {
                self.states.entry(leaf.clone()).or_default().insert(bits.clone(), name.join(" "));
                Ok(())
            }
            ("comment" | "date" | "version" | "attrend", _) => Ok(()),
            ("enddefinitions", _) => {
                self.state = ParserState::Body;
                Ok(())
            }
            ("scope", [_, name @ ..]) => self.names.scope(&name.join(" ")).map_err(|reason| self.refused(reason)),
            ("scope", []) => Err(self.refused("$scope without a kind and a name")),
            ("upscope", _) => self.names.upscope().map_err(|reason| self.refused(reason)),
            ("timescale", words) => self.timescale(&words.join(" ")),
            ("var", [kind, width, id, name @ ..]) if !name.is_empty() => self.var(kind, width, id, &name.join(" ")),
            ("var", words) => {
                Err(self.refused(format!("`$var {}` is not a type, a width, an id code and a name", words.join(" "))))
            }
            ("attrbegin", words) => {
                self.attribute(words);
                Ok(())
            }
            (other, _) => Err(self.refused(format!("`${other}` is not a command of the header of a VCD"))),
        }
    }

    fn timescale(&mut self, text: &str) -> Result<(), WaveError> {
        let scale = timescale::parse(text).map_err(|reason| self.refused(reason))?;
        match self.timescale {
            Some((before, line)) if before != scale => {
                Err(self.refused(format!("a $timescale of {scale}, but line {line} has one of {before}; leave one")))
            }
            _ => {
                self.timescale = Some((scale, self.line));
                Ok(())
            }
        }
    }

    /// Attributes say how a viewer shows a variable; nearly all of them mean nothing here.
    fn attribute(&mut self, words: &[String]) {
        // The types of VHDL that are signed: signed, integer, natural, positive.
        if let [misc, number, .., argument] = words
            && misc == "misc"
            && number == "02"
            && let Ok(argument) = argument.parse::<u64>()
        {
            self.signed = [9, 10, 12, 13].contains(&(argument & 1023));
        }
    }

    fn var(&mut self, kind: &str, width: &str, id: &str, name: &str) -> Result<(), WaveError> {
        let path = self.names.quoted(name);
        let Ok(width) = width.parse::<u32>() else {
            let reason = format!("`{path}` is declared `{width}` bits wide: the width is a whole number");
            return Err(self.refused(reason));
        };
        let mut open = false;
        let (mut kind, width) = match kind {
            "integer" | "int" | "shortint" | "longint" | "byte" => (ValueKind::Signed, width),
            "wire" | "reg" | "logic" | "bit" | "enum" | "time" | "port" | "sparray" | "supply0" | "supply1" | "tri"
            | "triand" | "trior" | "trireg" | "tri0" | "tri1" | "wand" | "wor" => (ValueKind::Unsigned, width),
            // A constant of any type.
            "parameter" => {
                open = true;
                (ValueKind::Unsigned, width)
            }
            // MyHDL declares enumerations as real, too.
            "real" | "realtime" | "shortreal" | "real_parameter" => {
                open = true;
                (ValueKind::Real, width)
            }
            "string" => (ValueKind::Text, width),
            "event" => (ValueKind::Event, width),
            other => return Err(self.refused(format!("`{other}`, the type of `{path}`, is not a type of variables"))),
        };
        let bits = matches!(kind, ValueKind::Unsigned | ValueKind::Signed);
        if bits && width > MAX_WIDTH {
            return Err(WaveError::TooWide { name: self.name.into(), path, width });
        }
        if std::mem::take(&mut self.signed) && bits {
            kind = ValueKind::Signed;
        }
        let stored_kind = if bits { ValueKind::Unsigned } else { kind };
        let declared = Declared { line: self.line, kind: stored_kind, width, open };
        let stored = match self.ids.get(id.as_bytes()) {
            Some(place) => {
                self.agree(place, &declared, &path, id)?;
                place
            }
            None => {
                self.ids.insert(id.as_bytes(), self.stored.len());
                self.declared.push(declared);
                self.stored.push(Changes::new(stored_kind, width));
                self.stored.len() - 1
            }
        };
        self.names.var(&Var { name, kind, width, stored }).map_err(|reason| self.refused(format!("`{path}`: {reason}")))
    }

    /// Two variables of one id code share their values.
    fn agree(&self, place: usize, new: &Declared, path: &str, id: &str) -> Result<(), WaveError> {
        let Some(old) = self.declared.get(place) else { return Ok(()) };
        if (old.kind, old.open) == (new.kind, new.open) && (old.kind != ValueKind::Unsigned || old.width == new.width) {
            return Ok(());
        }
        let of = |declared: &Declared| match declared.kind {
            ValueKind::Real => "a real".to_owned(),
            ValueKind::Text => "a string".to_owned(),
            ValueKind::Event => "an event".to_owned(),
            _ if declared.open => format!("a parameter of {} bits", declared.width),
            _ => format!("{} bits", declared.width),
        };
        Err(self.refused(format!(
            "`{path}` is {}, but shares its id code `{id}` with `{}` of line {}, which is {}",
            of(new),
            self.names.path_of(place),
            old.line,
            of(old)
        )))
    }
}
