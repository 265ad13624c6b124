//! What was simulated of the least widths, in words.

use crate::study::proof::Tried;

/// `1`, `1 and 2`, `1, 2 and 3`
fn list(ks: &[u32]) -> String {
    let words: Vec<String> = ks.iter().map(u32::to_string).collect();
    match &words[..] {
        [rest @ .., last] if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => words.concat(),
    }
}

fn bits(ks: &[u32]) -> String {
    format!("{} {}", list(ks), if ks == [1] { "bit" } else { "bits" })
}

/// What is known of each of these: the geometries that were simulated did as claimed, those that were refused did
/// nothing.
pub(super) fn simulated(tried: &[Tried]) -> String {
    let whole = |tried: &&Tried| tried.all && tried.as_claimed > 0 && tried.as_claimed == tried.geometries;
    let same: Vec<u32> = tried.iter().filter(whole).map(|tried| tried.k).collect();
    let mut text = String::new();
    if !same.is_empty() {
        text += &format!("simulated: the same for every geometry of {}\n", bits(&same));
    }
    for tried in tried.iter().filter(|tried| !whole(tried)) {
        let k = bits(&[tried.k]);
        let Tried { geometries, as_claimed, refused, given_up, .. } = tried;
        let why = tried.refusal.as_ref().map(|why| format!(": {why}")).unwrap_or_default();
        text += &match (*geometries, *refused) {
            (0, _) if tried.refusal.is_some() => format!("nothing claimed: there is no such hardware for {k}{why}\n"),
            (0, _) => format!("nothing claimed: there are no geometries of {k}\n"),
            (all, refused) if all == refused => {
                format!("nothing claimed: every one of {all} geometries of {k} is refused{why}\n")
            }
            _ => format!(
                "simulated: the same for {as_claimed} of {geometries} geometries of {k}; {refused} refused, {given_up} not \
                 run to their end{why}\n"
            ),
        };
    }
    text
}
