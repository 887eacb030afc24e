//! What is asked of `auto`: it is never done later than the best single engine times 1.15, plus 5 ms.

/// Whether it took too long.
pub fn is_late(auto: f64, best: f64) -> bool {
    auto > 1.15 * best + 5.0
}

/// Says which rows break the rule, if any do.
pub fn verdict(late: &[String]) -> String {
    if late.is_empty() {
        return "auto is never later than the best engine times 1.15, plus 5 ms.".to_owned();
    }
    format!("auto is LATER than the best engine times 1.15, plus 5 ms: {}.", late.join(", "))
}
