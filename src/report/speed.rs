//! Speed over v_max, in words and in JSON.

use serde_json::{Value, json};

pub use crate::testbench::RelativeSpeed;

/// For a summary: `0.7194 (step 152) to 0.7289 (step 32), mean 0.7263, ripple 1.30 %`.
pub(super) fn words(of: &RelativeSpeed) -> String {
    let [least, greatest] = [of.least, of.greatest].map(|(speed, step)| format!("{speed:.4} (step {step})"));
    let mean = of.mean.map(|mean| format!(", mean {mean:.4}")).unwrap_or_default();
    let ripple = of.ripple().map(|ripple| format!(", ripple {:.2} %", ripple * 100.0)).unwrap_or_default();
    format!("{least} to {greatest}{mean}{ripple}")
}

/// Adds its numbers to an object of the JSON report; without one they are null.
pub(super) fn put(of: Option<RelativeSpeed>, report: &mut Value) {
    let end = |(speed, step): (f64, u64)| json!({ "value": speed, "step": step });
    report["least"] = json!(of.map(|of| end(of.least)));
    report["mean"] = json!(of.and_then(|of| of.mean));
    report["greatest"] = json!(of.map(|of| end(of.greatest)));
}
