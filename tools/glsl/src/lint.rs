//! Refuses structures and computed indices in the shaders, because old drivers miscompile them.

use naga::{Expression, Function, Module, TypeInner};

/// Fails for a structure, or for an index that is not constant.
pub fn check(module: &Module) -> Result<(), String> {
    let structure = module.types.iter().find(|(_, ty)| matches!(ty.inner, TypeInner::Struct { .. }));
    if let Some((_, ty)) = structure {
        return Err(format!("a structure, {}", ty.name.as_deref().unwrap_or("without a name")));
    }
    let entries = module.entry_points.iter().map(|entry| &entry.function);
    for function in module.functions.iter().map(|(_, function)| function).chain(entries) {
        if has_computed_index(function) {
            return Err(format!(
                "a computed index in {}",
                function.name.as_deref().unwrap_or("the entry point")
            ));
        }
    }
    Ok(())
}

fn has_computed_index(function: &Function) -> bool {
    function.expressions.iter().any(|(_, expression)| matches!(expression, Expression::Access { .. }))
}

#[cfg(test)]
mod tests {
    use super::check;

    fn checked(body: &str) -> Result<(), String> {
        let source = format!("{body}\n@fragment fn main() -> @location(0) vec4u {{ return result(1u); }}");
        check(&naga::front::wgsl::parse_str(&source).map_err(|error| error.to_string())?)
    }

    #[test]
    fn constant_indices_pass() {
        assert_eq!(
            checked("fn result(i: u32) -> vec4u { let a = array<vec4u, 2>(); return a[1] * a[0].y * i; }"),
            Ok(())
        );
    }

    #[test]
    fn computed_indices_are_found() {
        let fault = checked("fn result(i: u32) -> vec4u { var a = array<vec4u, 2>(); return a[i]; }");
        assert_eq!(fault, Err("a computed index in result".to_owned()));
        let fault = checked("fn result(i: u32) -> vec4u { var v = vec4u(); return vec4u(v[i]); }");
        assert_eq!(fault, Err("a computed index in result".to_owned()));
    }

    #[test]
    fn structures_are_found() {
        let fault = checked(
            "struct Pair { a: u32, b: u32 }\nfn result(i: u32) -> vec4u { return vec4u(Pair(i, 1u).b); }",
        );
        assert_eq!(fault, Err("a structure, Pair".to_owned()));
    }
}
