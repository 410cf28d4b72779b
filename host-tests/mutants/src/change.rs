//! Which changes are made of what.

use syn::{BinOp, Expr, ReturnType, Type};

/// What is written instead of a binary operator. Those that take a value and assign it stay such.
#[must_use]
pub fn operators(op: &BinOp) -> &'static [&'static str] {
    match op {
        BinOp::Add(_) => &["-"],
        BinOp::Sub(_) => &["+"],
        BinOp::Mul(_) => &["+", "/"],
        BinOp::Div(_) => &["*"],
        BinOp::Rem(_) => &["/"],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::BitXor(_) | BinOp::BitOr(_) => &["&"],
        BinOp::BitAnd(_) => &["|"],
        BinOp::Shl(_) => &[">>"],
        BinOp::Shr(_) => &["<<"],
        BinOp::Eq(_) => &["!="],
        BinOp::Lt(_) => &["<=", ">="],
        BinOp::Le(_) => &["<", ">"],
        BinOp::Ne(_) => &["=="],
        BinOp::Ge(_) => &[">", "<"],
        BinOp::Gt(_) => &[">=", "<="],
        BinOp::AddAssign(_) => &["-="],
        BinOp::SubAssign(_) => &["+="],
        BinOp::MulAssign(_) => &["+=", "/="],
        BinOp::DivAssign(_) => &["*="],
        BinOp::RemAssign(_) => &["/="],
        BinOp::BitXorAssign(_) | BinOp::BitOrAssign(_) => &["&="],
        BinOp::BitAndAssign(_) => &["|="],
        BinOp::ShlAssign(_) => &[">>="],
        BinOp::ShrAssign(_) => &["<<="],
        _ => &[],
    }
}

/// What a function returns at once instead of what it does.
#[must_use]
pub fn results(output: &ReturnType) -> &'static [&'static str] {
    let ReturnType::Type(_, result) = output else {
        return &["()"];
    };
    match &**result {
        Type::Tuple(tuple) if tuple.elems.is_empty() => &["()"],
        Type::Path(path) => path.path.segments.last().map_or(&[], of_segment),
        _ => &[],
    }
}

fn of_segment(segment: &syn::PathSegment) -> &'static [&'static str] {
    match segment.ident.to_string().as_str() {
        "bool" => &["true", "false"],
        "u8" | "u16" | "u32" | "u64" | "u128" | "usize" | "i8" | "i16" | "i32" | "i64" | "i128"
        | "isize" => &["0", "1"],
        "Option" => &["None"],
        "Result" if is_of_nothing(&segment.arguments) => &["Ok(())"],
        _ => &[],
    }
}

/// Whether the first of the types between the angle brackets is `()`.
fn is_of_nothing(arguments: &syn::PathArguments) -> bool {
    let syn::PathArguments::AngleBracketed(list) = arguments else {
        return false;
    };
    matches!(list.args.first(),
        Some(syn::GenericArgument::Type(Type::Tuple(tuple))) if tuple.elems.is_empty())
}

/// Whether a condition binds names, so that nothing can be written instead of it.
#[must_use]
pub fn binds(condition: &Expr) -> bool {
    match condition {
        Expr::Let(_) => true,
        Expr::Binary(both) => binds(&both.left) || binds(&both.right),
        Expr::Paren(inner) => binds(&inner.expr),
        _ => false,
    }
}

/// Whether a condition is false in all programs for this computer.
#[must_use]
pub fn is_for_others(condition: &Expr) -> bool {
    matches!(condition, Expr::Path(path) if path.path.is_ident("SHORT"))
}

/// Whether leaving a statement out leaves a call out, and nothing else. What only tells compilers to keep a loop short is
/// none.
#[must_use]
pub fn is_call(expression: &Expr) -> bool {
    match expression {
        Expr::Call(call) => match &*call.func {
            Expr::Path(name) => name
                .path
                .segments
                .last()
                .is_none_or(|n| n.ident != "rolled"),
            _ => true,
        },
        Expr::MethodCall(_) => true,
        Expr::Try(inner) => is_call(&inner.expr),
        _ => false,
    }
}

/// Whether what the attributes stand before is in programs for this computer, as the proofs have it.
#[must_use]
pub fn is_compiled(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().all(|attribute| {
        !attribute.path().is_ident("test")
            && (!attribute.path().is_ident("cfg")
                || attribute
                    .parse_args::<syn::Meta>()
                    .is_ok_and(|meta| holds(&meta)))
    })
}

/// Whether a condition of compilation holds. Unknown ones do.
fn holds(meta: &syn::Meta) -> bool {
    let inner = || match meta {
        syn::Meta::List(list) => list
            .parse_args_with(
                syn::punctuated::Punctuated::<syn::Meta, syn::Token![,]>::parse_terminated,
            )
            .map(|metas| metas.into_iter().collect())
            .unwrap_or_default(),
        _ => Vec::new(),
    };
    let name = meta.path().get_ident().map(ToString::to_string);
    match name.as_deref() {
        Some("all") => inner().iter().all(holds),
        Some("any") => inner().iter().any(holds),
        Some("not") => !inner().iter().all(holds),
        Some("test" | "doctest" | "short_multiply") => false,
        Some("feature") => !is_string(meta, &["defmt", "memory-x"]),
        Some("target_endian") => is_string(meta, &["little"]),
        _ => true,
    }
}

fn is_string(meta: &syn::Meta, any: &[&str]) -> bool {
    let syn::Meta::NameValue(pair) = meta else {
        return false;
    };
    matches!(&pair.value, Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. })
        if any.contains(&text.value().as_str()))
}
