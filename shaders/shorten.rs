//! Shortens the shaders that browsers download: without comments, indentation and needless spaces, and with short names.

use std::collections::{BTreeMap, BTreeSet};

/// Shortens the texts of all files, which share their names. Entry points and overrides keep theirs, as the host names them.
pub fn shorten(texts: &mut [String]) {
    let bare: Vec<String> = texts.iter().map(|text| bare(text)).collect();
    let all = bare.concat();
    let pieces: Vec<Vec<&str>> = bare.iter().map(|text| pieces(text)).collect();
    let names = short_names(&all, &pieces.concat());
    for (text, pieces) in texts.iter_mut().zip(pieces) {
        text.clear();
        for piece in pieces {
            let locals = short_locals(piece, &names);
            for line in piece.lines() {
                *text += &if is_import(line) {
                    line.to_owned()
                } else {
                    without_spaces(&renamed(line, &names, &locals))
                };
                text.push('\n');
            }
        }
    }
}

fn is_import(line: &str) -> bool {
    line.starts_with("#import ")
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

/// A text without comments and indentation in pieces: each function is one, and so is what is between two of them.
fn pieces(text: &str) -> Vec<&str> {
    let mut pieces = Vec::new();
    let (mut begin, mut at) = (0, 0);
    for line in text.split_inclusive('\n') {
        if line.starts_with("fn ") {
            pieces.push(&text[begin..at]);
            begin = at;
        }
        at += line.len();
        let piece = &text[begin..at];
        let count = |brace: char| piece.matches(brace).count();
        if piece.starts_with("fn ") && count('{') > 0 && count('{') == count('}') {
            pieces.push(piece);
            begin = at;
        }
    }
    pieces.push(&text[begin..]);
    pieces
}

fn is_function(piece: &str) -> bool {
    piece.starts_with("fn ")
}

/// The words and marks of a text, each with the one before and the one after it.
fn in_context(text: &str) -> Vec<[&str; 3]> {
    let lines = text.lines().filter(|line| !is_import(line));
    let tokens: Vec<&str> = lines.flat_map(words).filter(|word| !word.trim().is_empty()).collect();
    let at = |i: usize| tokens.get(i).copied().unwrap_or("");
    (0..tokens.len()).map(|i| [at(i.wrapping_sub(1)), tokens[i], at(i + 1)]).collect()
}

/// The names that the files declare outside of functions, and shorter ones that no file has. The most frequent names get
/// the shortest.
fn short_names<'a>(all: &'a str, pieces: &[&'a str]) -> BTreeMap<&'a str, String> {
    let mut counts = BTreeMap::<&str, usize>::new();
    let (mut declared, mut functions, mut called, mut kept) =
        (BTreeSet::new(), BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    for [before, token, after] in in_context(all) {
        *counts.entry(token).or_default() += 1;
        if matches!(before, "fn" | "alias" | "struct") {
            functions.insert(token);
        } else if after == "(" {
            called.insert(token);
        }
        if before == "override" {
            kept.insert(token);
        }
    }
    for piece in pieces {
        for [before, token, after] in in_context(piece) {
            let is_declared = matches!(before, "var" | "const" | "alias" | "struct") || after == ":";
            if before == "fn" || is_declared && !is_function(piece) {
                declared.insert(token);
            }
        }
    }
    let code = || all.lines().filter(|line| !is_import(line));
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
    let free = short('A'..='Z').filter(|name| !counts.contains_key(name.as_str()));
    names.into_iter().zip(free).collect()
}

/// Some letters, then letters with a number.
fn short(letters: impl Iterator<Item = char>) -> impl Iterator<Item = String> {
    // The language has types such as f16.
    let with_number = |number| {
        let letters = ('a'..='z').chain('A'..='Z').filter(|letter| !"fiu".contains(*letter));
        letters.map(move |letter| format!("{letter}{number}"))
    };
    letters.map(String::from).chain((0..).flat_map(with_number))
}

/// The names that a function declares, and letters for them in the order in which they come: so functions look alike, and
/// take less when they are compressed.
fn short_locals<'a>(piece: &'a str, names: &BTreeMap<&str, String>) -> BTreeMap<&'a str, String> {
    let mut locals = Vec::new();
    let mut is_signature = is_function(piece);
    let tokens = in_context(piece);
    for &[before, token, after] in tokens.iter().filter(|_| is_function(piece)) {
        is_signature &= token != "{";
        let is_declared = matches!(before, "let" | "var" | "const") || is_signature && after == ":";
        if is_declared && !locals.contains(&token) {
            locals.push(token);
        }
    }
    let is_other = |&&[before, token, _]: &&[&str; 3]| before == "." || !locals.contains(&token);
    let others: BTreeSet<&str> = (tokens.iter().filter(is_other))
        .map(|&[_, token, _]| names.get(token).map_or(token, String::as_str))
        .collect();
    let free = short('a'..='z').filter(|name| !others.contains(name.as_str()));
    locals.into_iter().zip(free).collect()
}

/// A field of a structure is no local name.
fn renamed(line: &str, names: &BTreeMap<&str, String>, locals: &BTreeMap<&str, String>) -> String {
    let mut before = "";
    let mut text = String::new();
    for word in words(line) {
        let local = locals.get(word).filter(|_| before != ".");
        text += local.or_else(|| names.get(word)).map_or(word, String::as_str);
        before = word;
    }
    text
}

/// Spaces around these separate no words.
fn without_spaces(line: &str) -> String {
    let mut text = line.to_owned();
    for mark in
        ["==", "!=", "+=", "|=", "&&", "||", "->", "{", "}", ",", ";", ":", "=", "+", "*", "/", "%", "&", "|"]
    {
        text = text.replace(&format!(" {mark} "), mark).replace(&format!("{mark} "), mark);
    }
    text.replace(" {", "{")
}
