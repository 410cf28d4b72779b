//! Finds the mutants of a file.

use crate::change;
use crate::site::{Choice, ConstFn, Kind, Mutant, Site, Source};
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// Longest piece of source in the name of a mutant, in characters.
const QUOTED: usize = 48;

/// Reads one file. Its mutants are appended to `mutants`.
///
/// # Errors
/// A file that is no Rust.
pub fn file(file: &str, text: String, mutants: &mut Vec<Mutant>) -> Result<Source, String> {
    let tree = syn::parse_file(&text).map_err(|error| format!("{file}: {error}"))?;
    let mut found = Found {
        source: Source {
            file: file.to_owned(),
            text,
            sites: Vec::new(),
            const_fns: Vec::new(),
        },
        mutants,
        within: Vec::new(),
    };
    found.visit_file(&tree);
    Ok(found.source)
}

struct Found<'a> {
    source: Source,
    mutants: &'a mut Vec<Mutant>,
    /// Of each function around: its name where it is constant.
    within: Vec<Option<String>>,
}

impl Found<'_> {
    fn of(&self, part: &impl Spanned) -> &str {
        &self.source.text[part.span().byte_range()]
    }

    /// A site, with what takes its place and what that is called.
    fn site(&mut self, at: Range<usize>, kind: Kind, options: Vec<(String, String)>) {
        let (line, column) = position(&self.source.text, at.start);
        let text = self.source.text.lines().nth(line - 1).unwrap_or("").trim();
        let text = text.to_owned();
        let mut choices = Vec::new();
        for (what, instead) in options {
            choices.push(Choice {
                id: self.mutants.len(),
                text: instead,
            });
            let what = self.numbered(line, what);
            self.mutants.push(Mutant {
                file: self.source.file.clone(),
                line,
                column,
                what,
                text: text.clone(),
                const_fn: self.within.last().cloned().flatten(),
            });
        }
        self.source.sites.push(Site { at, kind, choices });
    }

    /// The name, told from equal ones on the same line.
    fn numbered(&self, line: usize, what: String) -> String {
        let mine = self.mutants.iter().rev();
        let mine = mine.take_while(|mutant| mutant.file == self.source.file);
        let is_same = |mutant: &&Mutant| {
            mutant.line == line && mutant.what.split(" #").next() == Some(what.as_str())
        };
        match mine.filter(is_same).count() {
            0 => what,
            before => format!("{what} #{}", before + 1),
        }
    }

    fn condition(&mut self, condition: &syn::Expr, values: &[&str]) {
        if change::binds(condition) || matches!(condition, syn::Expr::Lit(_)) {
            return;
        }
        let name = short(self.of(condition));
        let options = values.iter().map(|value| {
            let what = format!("{value} instead of the condition `{name}`");
            (what, (*value).to_owned())
        });
        self.site(
            condition.span().byte_range(),
            Kind::Instead,
            options.collect(),
        );
    }

    fn binary(&mut self, both: &syn::ExprBinary) {
        let operators = change::operators(&both.op);
        if operators.is_empty() || change::binds(&both.left) || change::binds(&both.right) {
            return;
        }
        let [left, right] = [&both.left, &both.right].map(|side| self.of(side).to_owned());
        let (name, old) = (short(self.of(both)), self.of(&both.op).to_owned());
        let assigns = old.ends_with('=') && !["==", "!=", "<=", ">="].contains(&old.as_str());
        let options = operators.iter().map(|new| {
            let text = if assigns {
                format!("{left} {new} {right}")
            } else {
                format!("({left}) {new} ({right})")
            };
            (format!("`{new}` instead of `{old}` in `{name}`"), text)
        });
        self.site(both.span().byte_range(), Kind::Instead, options.collect());
    }

    fn unary(&mut self, one: &syn::ExprUnary) {
        if matches!(one.op, syn::UnOp::Deref(_)) {
            return;
        }
        let inner = format!("({})", self.of(&one.expr));
        let what = format!("no `{}` in `{}`", self.of(&one.op), short(self.of(one)));
        self.site(one.span().byte_range(), Kind::Instead, vec![(what, inner)]);
    }

    fn literal(&mut self, literal: &syn::ExprLit) {
        let new = match &literal.lit {
            syn::Lit::Bool(value) => (!value.value).to_string(),
            syn::Lit::Int(number) => match number.base10_parse::<u128>() {
                Ok(value) => format!("{}{}", value + 1, number.suffix()),
                Err(_) => return,
            },
            _ => return,
        };
        let what = format!("`{new}` instead of `{}`", self.of(literal));
        self.site(
            literal.span().byte_range(),
            Kind::Instead,
            vec![(what, new)],
        );
    }

    /// One more at the end of a range, or one less where the end is within it.
    fn range(&mut self, range: &syn::ExprRange) {
        let Some(end) = &range.end else { return };
        if matches!(**end, syn::Expr::Lit(_)) {
            return;
        }
        let sign = match range.limits {
            syn::RangeLimits::HalfOpen(_) => '+',
            syn::RangeLimits::Closed(_) => '-',
        };
        let text = format!("({}) {sign} 1", self.of(end));
        let what = format!("an end of `{} {sign} 1`", short(self.of(end)));
        self.site(end.span().byte_range(), Kind::Instead, vec![(what, text)]);
    }

    /// What a function returns at once.
    fn body(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let inner = block.span().byte_range();
        let inner = inner.start + 1..inner.end - 1;
        let body = self.source.text[inner.clone()].trim().to_owned();
        let results = change::results(&signature.output);
        let options: Vec<_> = (results.iter())
            .filter(|result| **result != body && !(body.is_empty() && **result == "()"))
            .map(|result| {
                let what = format!("`{}` returns `{result}`", signature.ident);
                (what, (*result).to_owned())
            })
            .collect();
        if !options.is_empty() {
            self.site(inner.start..inner.start, Kind::Left, options);
        }
    }

    fn function(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let name = signature.ident.to_string();
        let constant = signature.constness.map(|keyword| {
            self.source.const_fns.push(ConstFn {
                name: name.clone(),
                keyword: keyword.span.byte_range(),
            });
            name
        });
        self.within.push(constant);
        self.body(signature, block);
        visit::visit_block(self, block);
        self.within.pop();
    }
}

/// Line and column, both from 1.
fn position(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at];
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
    (line, before[start..].chars().count() + 1)
}

/// A piece of source in one line, and not a long one.
fn short(source: &str) -> String {
    let words: Vec<&str> = source.split_whitespace().collect();
    let line = words.join(" ");
    if line.chars().count() <= QUOTED {
        return line;
    }
    let head: String = line.chars().take(QUOTED - 1).collect();
    format!("{head}…")
}

impl<'ast> Visit<'ast> for Found<'_> {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        use syn::Item::{Const, Enum, Fn, Impl, Mod, Trait};
        let attributes = match item {
            Fn(item) => &item.attrs,
            Mod(item) => &item.attrs,
            Impl(item) => &item.attrs,
            Trait(item) => &item.attrs,
            // What is constant, or has no code.
            Enum(_) | Const(_) | _ => return,
        };
        if change::is_compiled(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.function(&item.sig, &item.block);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        if change::is_compiled(&item.attrs) {
            self.function(&item.sig, &item.block);
        }
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(block) = item
            .default
            .as_ref()
            .filter(|_| change::is_compiled(&item.attrs))
        {
            self.function(&item.sig, block);
        }
    }

    fn visit_stmt(&mut self, statement: &'ast syn::Stmt) {
        match statement {
            syn::Stmt::Macro(_) => return,
            syn::Stmt::Local(local) if !change::is_compiled(&local.attrs) => return,
            syn::Stmt::Expr(expression, Some(_)) if change::is_call(expression) => {
                let what = format!("without `{}`", short(self.of(expression)));
                let at = statement.span().byte_range();
                self.site(at, Kind::LeftOut, vec![(what, String::new())]);
            }
            _ => {}
        }
        visit::visit_stmt(self, statement);
    }

    fn visit_expr(&mut self, expression: &'ast syn::Expr) {
        use syn::Expr::{Binary, Const, If, Lit, Macro, Range, Repeat, Unary, While};
        match expression {
            Const(_) | Macro(_) => return,
            // Its length is constant.
            Repeat(repeat) => return self.visit_expr(&repeat.expr),
            Binary(both) => self.binary(both),
            Unary(one) => self.unary(one),
            Lit(literal) => self.literal(literal),
            // Compiled for processors with short products alone, however it is written.
            If(choice) if change::is_for_others(&choice.cond) => {
                if let Some((_, otherwise)) = &choice.else_branch {
                    self.visit_expr(otherwise);
                }
                return;
            }
            If(choice) => self.condition(&choice.cond, &["true", "false"]),
            While(cycle) => self.condition(&cycle.cond, &["false"]),
            Range(range) => self.range(range),
            _ => {}
        }
        visit::visit_expr(self, expression);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        if let Some((_, guard)) = &arm.guard {
            self.condition(guard, &["true", "false"]);
        }
        visit::visit_arm(self, arm);
    }

    // Constant all through.
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
}

/// Files of tests: those of modules that are compiled for tests alone, and what is below them.
#[must_use]
pub fn test_modules(file: &str, text: &str) -> Vec<String> {
    let Ok(tree) = syn::parse_file(text) else {
        return Vec::new();
    };
    let is_head = ["mod.rs", "lib.rs"].iter().any(|name| file.ends_with(name));
    let parent = file.rsplit_once('/').map_or("", |(parent, _)| parent);
    let folder = if is_head {
        parent
    } else {
        file.trim_end_matches(".rs")
    };
    let mut found = Vec::new();
    for item in tree.items {
        let syn::Item::Mod(module) = item else {
            continue;
        };
        if module.content.is_some() || change::is_compiled(&module.attrs) {
            continue;
        }
        found.push(match named_path(&module.attrs) {
            Some(path) => format!("{parent}/{path}"),
            None => format!("{folder}/{}", module.ident),
        });
    }
    found
}

fn named_path(attributes: &[syn::Attribute]) -> Option<String> {
    let attribute = attributes
        .iter()
        .find(|attribute| attribute.path().is_ident("path"))?;
    let pair = attribute.meta.require_name_value().ok()?;
    match &pair.value {
        syn::Expr::Lit(syn::ExprLit {
            lit: syn::Lit::Str(text),
            ..
        }) => Some(text.value()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<String> {
        let mut mutants = Vec::new();
        file("src/a.rs", text.to_owned(), &mut mutants).unwrap();
        mutants.into_iter().map(|mutant| mutant.what).collect()
    }

    /// Kills: mutants of constants, tests, patterns and types, and of a condition that binds names.
    #[test]
    fn what_is_constant_has_no_mutants() {
        let none = "
            const A: u32 = 1 + 2;
            static B: [u8; 3] = [0; 3];
            enum C { D = 4 }
            #[cfg(test)] mod tests { fn f() -> bool { 1 < 2 } }
            #[cfg(all(feature = \"defmt\", not(test)))] fn f() -> bool { 1 < 2 }
            fn h() -> I { if SHORT { 8 } else { A } }
            fn g(x: [u8; 2]) -> [u8; 2] {
                const E: u32 = 5;
                match x { [6, 7] => x, _ => x }
            }";
        assert_eq!(all(none), [""; 0]);
        let bound = "fn f(x: Option<u8>) -> u8 { if let Some(y) = x { y } else { x.g::<3>() } }";
        assert_eq!(all(bound), ["`f` returns `0`", "`f` returns `1`"]);
    }

    /// Kills: equal names on one line, a body that is replaced by itself, and each kind of change
    /// that is not made.
    #[test]
    fn each_kind_of_change_has_its_name() {
        assert_eq!(
            all("fn f() -> bool { false }"),
            ["`f` returns `true`", "`true` instead of `false`"]
        );
        assert_eq!(
            all("fn f(a: i32) -> i64 { g(-a + a, 1, 1) }"),
            [
                "`f` returns `0`",
                "`f` returns `1`",
                "`-` instead of `+` in `-a + a`",
                "no `-` in `-a`",
                "`2` instead of `1`",
                "`2` instead of `1` #2"
            ]
        );
        assert_eq!(
            all("fn f(a: &mut A) -> B { a.push(); while a.b() { a.c |= a.d..=a.e; } }"),
            [
                "without `a.push()`",
                "false instead of the condition `a.b()`",
                "`&=` instead of `|=` in `a.c |= a.d..=a.e`",
                "an end of `a.e - 1`"
            ]
        );
        assert_eq!(
            all("fn f() { rolled(); num::rolled(); num::rolls(); }"),
            ["`f` returns `()`", "without `num::rolls()`"]
        );
    }

    /// Kills: modules of tests that are looked for in the wrong folder.
    #[test]
    fn files_of_tests_are_found() {
        let text = "mod a; #[cfg(test)] mod b; #[cfg(test)] #[path = \"d.rs\"] mod c;";
        assert_eq!(test_modules("src/x.rs", text), ["src/x/b", "src/d.rs"]);
        assert_eq!(
            test_modules("src/x/mod.rs", text),
            ["src/x/b", "src/x/d.rs"]
        );
    }
}
