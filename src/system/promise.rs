//! Promises that reject if an exception or a trap occurs while a future is polled. The promises of wasm-bindgen would
//! never settle, and the exception would end a Node process.

use js_sys::{Function, Promise, Reflect};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Wake};
use wasm_bindgen::prelude::*;

type Task = Pin<Box<dyn Future<Output = Result<JsValue, JsValue>>>>;

#[wasm_bindgen]
extern "C" {
    /// A promise with a `then` whose callback returns a promise.
    #[wasm_bindgen(js_name = Promise)]
    type Waking;
    #[wasm_bindgen(constructor, js_class = "Promise")]
    fn new(executor: &mut dyn FnMut(Function)) -> Waking;
    #[wasm_bindgen(method)]
    fn then(this: &Waking, continuation: JsValue) -> Promise;
}

/// A promise of the result of a future. The future is polled at once. If it is then ready, the promise has its result as
/// a field, `value` or `error`, so that `src/js/sync.ts` need not wait.
pub(crate) fn promise(future: impl Future<Output = Result<JsValue, JsValue>> + 'static) -> Promise {
    poll(Box::pin(future))
}

/// An exception in here rejects the promise. The future is then leaked with everything it owns: WebAssembly does not
/// unwind.
fn poll(task: Task) -> Promise {
    let mut task = Some(task);
    let mut ready = None;
    let promise = Promise::new(&mut |resolve, reject| {
        let Some(mut task) = task.take() else { return };
        let mut wake = None;
        let woken = Waking::new(&mut |resolve| wake = Some(resolve));
        let waker = Arc::new(Alarm(wake)).into();
        let (settle, value) = match task.as_mut().poll(&mut Context::from_waker(&waker)) {
            Poll::Ready(result) => {
                let (settle, field, value) = match result {
                    Ok(value) => (resolve, "value", value),
                    Err(thrown) => (reject, "error", thrown),
                };
                ready = Some((field, value.clone()));
                (settle, value)
            }
            Poll::Pending => (resolve, woken.then(Closure::once_into_js(move || poll(task))).into()),
        };
        // These functions throw nothing.
        let _ = settle.call1(&JsValue::UNDEFINED, &value);
    });
    if let Some((field, value)) = ready {
        // Setting a field of a promise does not fail.
        let _ = Reflect::set(&promise, &field.into(), &value);
    }
    promise
}

/// Resolves the promise that the task waits for.
struct Alarm(Option<Function>);

#[expect(unsafe_code, reason = "wakers can be sent, and a function of JavaScript cannot")]
// SAFETY: only promises of JavaScript wake a task, and they belong to the thread that polls it.
unsafe impl Send for Alarm {}

#[expect(unsafe_code, reason = "as above")]
// SAFETY: as above.
unsafe impl Sync for Alarm {}

impl Wake for Alarm {
    fn wake(self: Arc<Self>) {
        if let Some(resolve) = &self.0 {
            let _ = resolve.call0(&JsValue::UNDEFINED);
        }
    }
}
