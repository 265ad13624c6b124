//! What an operator does while a machine runs, and the inputs that it changes.

use std::fmt;

use crate::parts::WHOLE_OVERRIDE;

/// What an operator does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Action {
    /// Stops, along the ramp.
    Hold,
    /// Continues after a hold.
    Resume,
    /// Sets the feed to this share of what is commanded, in percent, 0 to 200; 0 is a hold too.
    Override(u32),
    /// Lets every block be followed by a stop until `Start`.
    Single,
    /// Takes `Single` back.
    Continuous,
    /// Lets the next block begin after a stop.
    Start,
}

/// The words of actions, and what of the text after `=` makes them.
const WORDS: [(&str, Action); 5] = [
    ("hold", Action::Hold),
    ("resume", Action::Resume),
    ("single", Action::Single),
    ("continuous", Action::Continuous),
    ("start", Action::Start),
];

/// Greatest override in percent.
const MOST_PERCENT: u32 = 200;

impl Action {
    /// The inputs that it changes: how many clocks later, the name, and the number that it takes.
    #[must_use]
    pub fn inputs(self) -> Vec<(u64, &'static str, i128)> {
        match self {
            Action::Hold => vec![(0, "hold", 1)],
            Action::Resume => vec![(0, "hold", 0)],
            Action::Override(percent) => {
                let share = (WHOLE_OVERRIDE * percent + 50) / 100;
                vec![(0, "trim", i128::from(share) - i128::from(WHOLE_OVERRIDE))]
            }
            Action::Single => vec![(0, "single", 1)],
            Action::Continuous => vec![(0, "single", 0)],
            Action::Start => vec![(0, "start", 1), (1, "start", 0)],
        }
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Action::Override(percent) = self {
            return write!(f, "override={percent}");
        }
        f.write_str(WORDS.iter().find(|(_, action)| action == self).map_or("", |(word, _)| word))
    }
}

/// An action at a clock: it is in force at the edge after that of this clock.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Timed {
    /// The clock, from 0.
    pub clock: u64,
    /// The action.
    pub action: Action,
}

impl Timed {
    /// The action of a text: `900:hold`, `1200:override=50`.
    ///
    /// # Errors
    /// A sentence that says what is wrong with it.
    pub fn parse(text: &str) -> Result<Timed, String> {
        let remedy = || {
            let words = WORDS.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
            format!(
                "invalid event '{text}': give CLOCK:EVENT such as 900:hold; events are {words} and override=PERCENT"
            )
        };
        let (clock, word) = text.split_once(':').ok_or_else(remedy)?;
        let clock = clock.trim().parse().map_err(|_| remedy())?;
        let word = word.trim();
        if let Some(percent) = word.strip_prefix("override=") {
            let number = percent.trim_end_matches('%').trim().parse().ok();
            let percent = number.filter(|percent| *percent <= MOST_PERCENT).ok_or_else(|| {
                format!("invalid override '{percent}' in event '{text}': give a percentage from 0 to {MOST_PERCENT}")
            })?;
            return Ok(Timed { clock, action: Action::Override(percent) });
        }
        let action = WORDS.iter().find(|(known, _)| *known == word).map(|(_, action)| *action).ok_or_else(remedy)?;
        Ok(Timed { clock, action })
    }
}

/// `900:hold`
impl fmt::Display for Timed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.clock, self.action)
    }
}
