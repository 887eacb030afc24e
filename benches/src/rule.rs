//! The rule for `auto`: it takes at most the time of the best single engine times 1.15, plus 5 ms.

/// Whether `auto` breaks the rule. Times in milliseconds.
pub fn is_late(auto: f64, best: f64) -> bool {
    auto > 1.15 * best + 5.0
}

/// A sentence that names the rows that break the rule, if any.
pub fn verdict(late: &[String]) -> String {
    if late.is_empty() {
        return "auto is never later than the best engine times 1.15, plus 5 ms.".to_owned();
    }
    format!("auto is LATER than the best engine times 1.15, plus 5 ms: {}.", late.join(", "))
}
