//! Parameters that are tied to others: `"derive": { "mu_static": "1.4 * mu" }`.

use super::error::Problem;
use super::locate::join;
use super::parameter::{Kind, Parameter, unknown_help};
use super::source::SourceText;
use crate::spec::FieldError;
use exmex::{BinOp, Express, FlatEx, MakeOperators, MatchLiteral, Operator, literal_matcher_from_pattern};
use serde_json::{Map, Value};

/// The field of a study file.
pub(super) const DERIVE: &str = "derive";

/// Significant digits of derived values. So 1.4 · 0.3 is 0.42, and the job is that of a listed 0.42.
const DIGITS: usize = 12;

/// Parameters with their expressions, each after those that it depends on.
#[derive(Debug, Clone, Default)]
pub(super) struct Ties(Vec<Tie>);

#[derive(Debug, Clone)]
struct Tie {
    parameter: &'static Parameter,
    expression: Expression,
    text: String,
    /// What it depends on, in the order of the expression's variables.
    inputs: Vec<&'static Parameter>,
}

type Expression = FlatEx<f64, Operators, Numbers>;

literal_matcher_from_pattern!(Numbers, r"^(\.?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?)");

/// The operators of expressions. They give the same bits on every machine.
#[derive(Debug, Clone)]
struct Operators;

impl MakeOperators<f64> for Operators {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        let binary = |apply: fn(f64, f64) -> f64, prio| BinOp { apply, prio, is_commutative: false };
        vec![
            Operator::make_bin("^", binary(libm::pow, 4)),
            Operator::make_bin("*", binary(|a, b| a * b, 2)),
            Operator::make_bin("/", binary(|a, b| a / b, 3)),
            Operator::make_bin_unary("+", binary(|a, b| a + b, 0), |a| a),
            Operator::make_bin_unary("-", binary(|a, b| a - b, 1), |a| -a),
            Operator::make_unary("sqrt", f64::sqrt),
            Operator::make_unary("exp", libm::exp),
            Operator::make_unary("ln", libm::log),
            Operator::make_unary("abs", f64::abs),
            Operator::make_constant("pi", std::f64::consts::PI),
        ]
    }
}

impl Ties {
    /// Those of a study whose ties have been checked.
    pub fn of(study: &Value) -> Self {
        let given = study.get(DERIVE).and_then(Value::as_object);
        let ties = given.into_iter().flatten().filter_map(|(name, text)| {
            let parameter = Parameter::find(name)?;
            Tie::read(parameter, text.as_str()?).ok()
        });
        Self(sorted(ties.collect()).unwrap_or_default())
    }

    /// What is wrong with the ties of a study that varies these parameters.
    pub fn problems(given: &Map<String, Value>, varied: &[&Parameter], source: &SourceText) -> Vec<Problem> {
        let mut found = Vec::new();
        let mut ties = Vec::new();
        for (name, text) in given {
            let path = join(DERIVE, name);
            let Some(parameter) = Parameter::find(name) else {
                let problem = source.problem_with_name(&path, "no such parameter");
                found.push(Problem { help: unknown_help(name), ..problem });
                continue;
            };
            let mut refuse = |message: String| found.push(source.problem(&path, message));
            if !matches!(parameter.kind, Kind::Number) {
                refuse("expected a parameter that is a number with decimals".to_owned());
                continue;
            }
            if let Some(other) = varied.iter().find(|other| other.overlaps(parameter)) {
                refuse(format!("{} varies it, too; expected only one of the two", other.name));
                continue;
            }
            if source.gives(&parameter.field()) {
                refuse(format!("{} gives it, too; expected only one of the two", parameter.field()));
                continue;
            }
            match text.as_str().map(|text| Tie::read(parameter, text)) {
                None => refuse("expected an expression as a text, such as \"1.4 * mu\"".to_owned()),
                Some(Err(Refusal { message, unknown })) => {
                    let problem = source.problem(&path, message);
                    let help = unknown.map_or_else(Vec::new, |name| unknown_help(&name));
                    found.push(Problem { help, ..problem });
                }
                Some(Ok(tie)) => ties.push(tie),
            }
        }
        if let Err(circle) = sorted(ties) {
            let names: Vec<&str> = circle.iter().map(|own| own.name).collect();
            let message = format!("they depend on each other in a circle: {}", names.join(", "));
            found.push(source.problem(&join(DERIVE, names[0]), message));
        }
        found
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The parameters that are tied.
    pub fn parameters(&self) -> impl Iterator<Item = &'static Parameter> {
        self.0.iter().map(|tie| tie.parameter)
    }

    /// Gives each tied parameter its value, from those in `values`. `is_known` says whether a parameter has its value there.
    pub fn apply(
        &self,
        values: &mut Value,
        is_known: impl Fn(&Parameter) -> bool,
    ) -> Result<(), Vec<FieldError>> {
        let mut found = Vec::new();
        for Tie { parameter, expression, text, inputs } in &self.0 {
            let refuse = |expected: String| FieldError {
                field: parameter.field(),
                value: format!("{text:?}"),
                expected,
            };
            let number = |own: &&'static Parameter| {
                let value = values.pointer(own.pointer).and_then(Value::as_f64);
                value.filter(|_| is_known(own)).ok_or(own.name)
            };
            let numbers: Result<Vec<f64>, &str> = inputs.iter().map(number).collect();
            let value = match numbers {
                Err(name) => Err(refuse(format!("a value of {name} in the study or its grid"))),
                Ok(numbers) => match expression.eval(&numbers) {
                    Ok(value) if value.is_finite() => Ok(rounded(value)),
                    _ => Err(refuse("an expression with a finite value".to_owned())),
                },
            };
            match value {
                Ok(value) => parameter.set(values, &value.into()),
                Err(error) => found.push(error),
            }
        }
        if found.is_empty() { Ok(()) } else { Err(found) }
    }
}

fn rounded(value: f64) -> f64 {
    format!("{value:.0$e}", DIGITS - 1).parse().unwrap_or(value)
}

/// Why an expression cannot be used.
struct Refusal {
    message: String,
    /// The name in it that is no parameter.
    unknown: Option<String>,
}

impl Tie {
    fn read(parameter: &'static Parameter, text: &str) -> Result<Self, Refusal> {
        let refuse = |message: &str| Refusal { message: message.to_owned(), unknown: None };
        let expression = Expression::parse(text).map_err(|_| {
            refuse("not an expression; expected numbers, parameters, + - * / ^ ( ), sqrt(), exp(), ln(), abs(), pi, with an operator between two values")
        })?;
        if has_unclear_power(text) {
            return Err(refuse("unclear order of powers; expected brackets, such as -(mu^2) or 2^(3^2)"));
        }
        let input = |name: &String| match Parameter::find(name) {
            Some(own) if matches!(own.kind, Kind::Number | Kind::Count) => Ok(own),
            Some(_) => Err(Refusal { message: format!("{name} is no number"), unknown: None }),
            None => {
                Err(Refusal { message: format!("{name}: no such parameter"), unknown: Some(name.clone()) })
            }
        };
        let inputs = expression.var_names().iter().map(input).collect::<Result<_, _>>()?;
        Ok(Self { parameter, expression, text: text.to_owned(), inputs })
    }
}

/// Whether a sign stands before the base of a power, or a power is the base of another one without brackets: programs differ in what they make
/// of these.
fn has_unclear_power(text: &str) -> bool {
    let letters: Vec<char> = text.chars().filter(|letter| !letter.is_whitespace()).collect();
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '.';
    letters.iter().enumerate().filter(|(_, letter)| **letter == '^').any(|(at, _)| {
        let mut start = at;
        if start > 0 && letters[start - 1] == ')' {
            let mut open = 0;
            while start > 0 {
                start -= 1;
                open += i32::from(letters[start] == ')') - i32::from(letters[start] == '(');
                if open == 0 {
                    break;
                }
            }
        }
        while start > 0 && is_part(letters[start - 1]) {
            start -= 1;
        }
        let before = start.checked_sub(1).map(|at| letters[at]);
        let two_before = start.checked_sub(2).map(|at| letters[at]);
        let is_sign =
            matches!(before, Some('-' | '+')) && two_before.is_none_or(|own| !is_part(own) && own != ')');
        before == Some('^') || is_sign
    })
}

/// The ties in an order in which each comes after those that it depends on; otherwise the parameters of a circle.
fn sorted(mut left: Vec<Tie>) -> Result<Vec<Tie>, Vec<&'static Parameter>> {
    let mut sorted: Vec<Tie> = Vec::new();
    while !left.is_empty() {
        let waits = |tie: &Tie| tie.inputs.iter().any(|own| left.iter().any(|other| other.parameter == *own));
        let Some(at) = left.iter().position(|tie| !waits(tie)) else {
            // What only depends on a circle is no part of it.
            while let Some(at) =
                left.iter().position(|tie| !left.iter().any(|other| other.inputs.contains(&tie.parameter)))
            {
                left.remove(at);
            }
            return Err(left.iter().map(|tie| tie.parameter).collect());
        };
        sorted.push(left.remove(at));
    }
    Ok(sorted)
}
