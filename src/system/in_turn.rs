//! Work that concurrent calls do one after another, because the first call does what the others need.

use super::promise::promise;
use js_sys::{Object, Promise};
use std::cell::RefCell;
use std::rc::Rc;
use std::thread::LocalKey;
use wasm_bindgen::JsValue;
use wasm_bindgen_futures::JsFuture;

/// The promise of the work that is running now.
pub(crate) type Running = LocalKey<RefCell<Option<Promise>>>;

/// The result of `work`. While `is_ready` is false, only one call of those with the same `running` does its work; the
/// others wait for it. An exception in the work ends this call, and no other.
pub(crate) async fn in_turn<T: 'static>(
    running: &'static Running,
    is_ready: impl Fn() -> bool,
    work: impl Future<Output = T> + 'static,
) -> T {
    // Every waiter does this, because an exception may have ended the call that began the work.
    let end = |ended: &Promise| running.with_borrow_mut(|now| now.take_if(|now| Object::is(now, ended)));
    while !is_ready()
        && let Some(other) = running.with_borrow(Clone::clone)
    {
        // An error is for the call that began the work, so it is ignored here.
        let _ = JsFuture::from(other.clone()).await;
        end(&other);
    }
    if is_ready() {
        return work.await;
    }
    let result = Rc::new(RefCell::new(None));
    let slot = result.clone();
    let ours = promise(async move {
        slot.replace(Some(work.await));
        Ok(JsValue::UNDEFINED)
    });
    running.set(Some(ours.clone()));
    let settled = JsFuture::from(ours.clone()).await;
    end(&ours);
    match (settled, result.take()) {
        (Ok(_), Some(result)) => result,
        (Ok(thrown) | Err(thrown), _) => wasm_bindgen::throw_val(thrown),
    }
}
