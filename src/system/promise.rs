//! Promises that hear of everything: an exception or a trap while a future is polled rejects them. Those of wasm-bindgen
//! never settle then, and the exception ends a process of Node.

use js_sys::{Function, Promise};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Wake};
use wasm_bindgen::prelude::*;

type Task = Pin<Box<dyn Future<Output = Result<JsValue, JsValue>>>>;

#[wasm_bindgen]
extern "C" {
    /// A promise whose `then` takes what a promise gives.
    #[wasm_bindgen(js_name = Promise)]
    type Waking;
    #[wasm_bindgen(constructor, js_class = "Promise")]
    fn new(executor: &mut dyn FnMut(Function)) -> Waking;
    #[wasm_bindgen(method)]
    fn then(this: &Waking, go_on: JsValue) -> Promise;
}

/// A promise of what the future gives. It is polled at once.
pub(crate) fn promise(future: impl Future<Output = Result<JsValue, JsValue>> + 'static) -> Promise {
    poll(Box::pin(future))
}

/// An exception in here rejects the promise. The future is lost then, with all that it has: WebAssembly unwinds nothing.
fn poll(task: Task) -> Promise {
    let mut task = Some(task);
    Promise::new(&mut |resolve, reject| {
        let Some(mut task) = task.take() else { return };
        let mut wake = None;
        let woken = Waking::new(&mut |resolve| wake = Some(resolve));
        let waker = Arc::new(Alarm(wake)).into();
        let (settle, value) = match task.as_mut().poll(&mut Context::from_waker(&waker)) {
            Poll::Ready(Ok(value)) => (resolve, value),
            Poll::Ready(Err(thrown)) => (reject, thrown),
            Poll::Pending => (resolve, woken.then(Closure::once_into_js(move || poll(task))).into()),
        };
        // These functions throw nothing.
        let _ = settle.call1(&JsValue::UNDEFINED, &value);
    })
}

/// Resolves the promise that the task waits for.
struct Alarm(Option<Function>);

#[expect(unsafe_code, reason = "wakers can be sent, and a function of JavaScript cannot")]
// SAFETY: who polls a task is woken by promises of JavaScript, and these are of the same thread.
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
