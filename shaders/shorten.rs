//! Shortens the shaders that browsers download: without comments, indentation and needless spaces, and with short names.

use std::collections::{BTreeMap, BTreeSet};

/// Shortens the texts of all files, which share their names. Entry points and overrides keep theirs, as the host names them.
pub fn shorten(texts: &mut [String]) {
    let bare: Vec<String> = texts.iter().map(|text| bare(text)).collect();
    let all = bare.concat();
    let names = short_names(&all);
    for (text, bare) in texts.iter_mut().zip(&bare) {
        let lines = bare.lines().map(|line| {
            if line.starts_with("#import ") {
                line.to_owned()
            } else {
                without_spaces(&renamed(line, &names))
            }
        });
        *text = lines.flat_map(|line| [line, "\n".to_owned()]).collect();
    }
}

fn bare(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or("").trim());
    lines.filter(|line| !line.is_empty()).flat_map(|line| [line, "\n"]).collect()
}

/// The words and what stands between them. A number with its suffix is a word.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split_inclusive(move |c| !is_part(c)).flat_map(move |piece| {
        let end = piece.find(|c| !is_part(c)).unwrap_or(piece.len());
        [&piece[..end], &piece[end..]]
    })
}

/// The names that the files declare, and shorter ones that no file has. The most frequent names get the shortest.
fn short_names(all: &str) -> BTreeMap<&str, String> {
    let code = || all.lines().filter(|line| !line.starts_with("#import "));
    let tokens: Vec<&str> = code().flat_map(words).filter(|word| !word.trim().is_empty()).collect();
    let mut counts = BTreeMap::<&str, usize>::new();
    let (mut declared, mut functions, mut called, mut kept) =
        (BTreeSet::new(), BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    for (i, &token) in tokens.iter().enumerate() {
        let before = i.checked_sub(1).map_or("", |before| tokens[before]);
        let after = tokens.get(i + 1).copied().unwrap_or("");
        *counts.entry(token).or_default() += 1;
        if matches!(before, "fn" | "alias" | "struct") {
            functions.insert(token);
        } else if after == "(" {
            called.insert(token);
        }
        if before == "override" {
            kept.insert(token);
        }
        if matches!(before, "fn" | "let" | "var" | "const" | "alias" | "struct") || after == ":" {
            declared.insert(token);
        }
    }
    for (attributes, line) in code().zip(code().skip(1)) {
        if attributes.starts_with("@compute") {
            kept.extend(words(line.trim_start_matches("fn ")).next());
        }
    }
    // A name that is called and that no file defines is a function of the language.
    let of_language = called.difference(&functions).copied().collect::<BTreeSet<_>>();
    let mut names: Vec<&str> = declared
        .into_iter()
        .filter(|name| name.len() > 2 && name.starts_with(|c: char| c.is_ascii_alphabetic()))
        .filter(|name| !kept.contains(name) && !of_language.contains(name))
        .collect();
    names.sort_by_key(|name| (usize::MAX - counts[name], *name));
    let letters = || ('a'..='z').chain('A'..='Z');
    let single = letters().map(String::from);
    // The language has types such as f16.
    let longer = (0..).flat_map(|number| {
        letters().filter(|letter| !"fiu".contains(*letter)).map(move |letter| format!("{letter}{number}"))
    });
    let free = single.chain(longer).filter(|name| !counts.contains_key(name.as_str()));
    names.into_iter().zip(free).collect()
}

fn renamed(line: &str, names: &BTreeMap<&str, String>) -> String {
    words(line).map(|word| names.get(word).map_or(word, String::as_str)).collect()
}

/// Spaces around these separate no words.
fn without_spaces(line: &str) -> String {
    let mut text = line.to_owned();
    for mark in ["==", "!=", "+=", "|=", "&&", "||", "{", "}", ",", ";", ":", "=", "+", "*"] {
        text = text.replace(&format!(" {mark} "), mark).replace(&format!("{mark} "), mark);
    }
    text.replace(" {", "{")
}
