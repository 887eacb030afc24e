//! Points that move, come and go, for the npm package. The only caller is `src/js/point-session.ts`, which has made sure
//! that indices are whole numbers.

use super::point_values::{in_words_of_points, positions, triangulation_object};
use crate::wasm::values::JsPositions;
use js_sys::Uint32Array;
use wasm_bindgen::prelude::*;

/// As [`PointSession`](crate::PointSession).
#[wasm_bindgen]
pub struct PointSession(crate::PointSession);

#[wasm_bindgen]
impl PointSession {
    /// As [`PointSession::new`](crate::PointSession::new).
    ///
    /// # Errors
    /// Those of [`PointSession::new`](crate::PointSession::new).
    #[wasm_bindgen(constructor)]
    pub fn new(points: JsPositions) -> Result<Self, JsValue> {
        let open = || crate::PointSession::new(&positions(points)?, None);
        open().map(Self).map_err(in_words_of_points)
    }

    /// The number of points.
    #[wasm_bindgen(getter)]
    pub fn length(&self) -> u32 {
        self.0.len() as u32
    }

    /// As [`PointSession::update`](crate::PointSession::update).
    ///
    /// # Errors
    /// Those of [`PointSession::update`](crate::PointSession::update).
    pub fn update(&mut self, points: JsPositions) -> Result<(), JsValue> {
        let points = positions(points).map_err(in_words_of_points)?;
        self.0.update(&points).map_err(in_words_of_points)
    }

    /// As [`PointSession::move_to`](crate::PointSession::move_to).
    ///
    /// # Errors
    /// Those of [`PointSession::move_to`](crate::PointSession::move_to).
    #[wasm_bindgen(js_name = moveTo)]
    pub fn move_to(&mut self, index: u32, x: f64, y: f64) -> Result<(), JsValue> {
        self.0.move_to(index, [x, y]).map_err(in_words_of_points)
    }

    /// As [`PointSession::add`](crate::PointSession::add).
    ///
    /// # Errors
    /// Those of [`PointSession::add`](crate::PointSession::add).
    pub fn add(&mut self, x: f64, y: f64) -> Result<u32, JsValue> {
        self.0.add([x, y]).map_err(in_words_of_points)
    }

    /// As [`PointSession::remove`](crate::PointSession::remove).
    pub fn remove(&mut self, index: u32) -> bool {
        self.0.remove(index)
    }

    /// As [`PointSession::triangulation`](crate::PointSession::triangulation).
    ///
    /// # Errors
    /// Those of [`PointSession::triangulation`](crate::PointSession::triangulation).
    #[wasm_bindgen(unchecked_return_type = "Arrays")]
    pub fn triangulation(&mut self) -> Result<JsValue, JsValue> {
        self.0.triangulation().map(|result| triangulation_object(&result)).map_err(in_words_of_points)
    }

    /// As [`PointSession::triangles`](crate::PointSession::triangles).
    ///
    /// # Errors
    /// Those of [`PointSession::triangles`](crate::PointSession::triangles).
    pub fn triangles(&mut self) -> Result<Uint32Array, JsValue> {
        self.0.triangles().map(|triangles| Uint32Array::from(&*triangles)).map_err(in_words_of_points)
    }

    /// As [`PointSession::hull`](crate::PointSession::hull).
    pub fn hull(&mut self) -> Uint32Array {
        Uint32Array::from(&*self.0.hull())
    }

    /// As [`PointSession::locate`](crate::PointSession::locate).
    #[wasm_bindgen(unchecked_return_type = "[number, number, number] | undefined")]
    pub fn locate(&mut self, x: f64, y: f64) -> JsValue {
        let list = |corners: [u32; 3]| corners.into_iter().map(JsValue::from).collect::<js_sys::Array>();
        self.0.locate([x, y]).map_or(JsValue::UNDEFINED, |corners| list(corners).into())
    }

    /// As [`PointSession::nearest`](crate::PointSession::nearest).
    pub fn nearest(&mut self, x: f64, y: f64) -> Option<u32> {
        self.0.nearest([x, y])
    }
}
