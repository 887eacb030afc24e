//! The words of the summary: numbers, lists, and what to do.

use edgeflip::Reasons;
use indicatif::HumanCount;
use std::collections::BTreeMap;

/// The attributes that edges stay for, and what lets them flip.
pub fn kept(by_name: &[(String, usize)]) -> String {
    // On one line, printable, short.
    let printable = |name: &str| name.chars().take(40).flat_map(char::escape_debug).collect::<String>();
    let of_each =
        |(name, count): &(String, usize)| format!("{} `{}`", HumanCount(*count as u64), printable(name));
    match by_name {
        [(name, _)] => {
            let name = printable(name);
            format!("the attribute `{name}`; --ignore-attribute {name} lets them flip")
        }
        _ => format!(
            "attributes: {}; an edge may flip if --ignore-attribute names all that it stays for",
            first(&by_name.iter().map(of_each).collect::<Vec<_>>())
        ),
    }
}

/// Formats a number of any size.
pub fn short(number: f64) -> String {
    if number == 0.0 || (1e-3..1e7).contains(&number.abs()) {
        format!("{number:.4}")
    } else {
        format!("{number:.3e}")
    }
}

/// Formats a number before and after, and its relative change.
pub fn change(before: f64, after: f64) -> String {
    let part = if before == after { 0.0 } else { (after - before) / before.abs() };
    format!("{} → {} ({:+.4} %)", short(before), short(after), 100.0 * part)
}

/// What to do about triangles that are turned over, and about flat ones.
pub const INVERTED: &str = "they overlap their neighbours, and no flip could turn them back: --untangle does, wherever the \
                        points have a triangulation; else move their vertices back";
pub const FLAT: &str = "their corners are on one line, and no flip removed them: in the plane try --untangle; else move a \
                    corner of each, or leave it out";

/// The first edges left for each reason, named by their vertices.
pub fn first_edges(remaining: &BTreeMap<&str, Vec<[u32; 2]>>) -> String {
    let names = |edges: &[[u32; 2]]| edges.iter().map(|[u, v]| format!("{u}-{v}")).collect::<Vec<_>>();
    let parts: Vec<String> =
        remaining.iter().map(|(reason, edges)| format!("{reason} {}", first(&names(edges)))).collect();
    parts.join("; ")
}

/// The first items of a list, as text.
pub fn first(items: &[impl ToString]) -> String {
    const LISTED: usize = 5;
    let first: Vec<String> = items.iter().take(LISTED).map(ToString::to_string).collect();
    let more = match items.len().saturating_sub(LISTED) {
        0 => String::new(),
        n => format!(" and {} more", HumanCount(n as u64)),
    };
    first.join(", ") + &more
}

/// The numbers of edges left by reason, as text.
pub fn reasons(left: &Reasons) -> String {
    let parts: Vec<String> =
        left.iter().map(|(reason, n)| format!("{} {}", reason.name(), HumanCount(n))).collect();
    match parts.len() {
        0 => "no edge that is not Delaunay".into(),
        _ => format!("not Delaunay: {}", parts.join(", ")),
    }
}
