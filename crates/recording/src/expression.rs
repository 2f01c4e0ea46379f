//! Right side of a calibration: sums of products of numbers and one column, as in `125 * ai0 - 12.5`.

/// Reason why an expression is not linear in one column.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExpressionFault {
    /// A number, a column or an operator missing.
    #[error("a number or a column is missing")]
    Incomplete,
    /// Two operands side by side.
    #[error("an operator is missing")]
    OperatorMissing,
    /// Quotes that are not closed.
    #[error("a quote is not closed")]
    OpenQuote,
    /// Digits that make no number.
    #[error("\"{word}\" is not a number")]
    BadNumber {
        /// The digits.
        word: String,
    },
    /// No column.
    #[error("no column is named")]
    NoColumn,
    /// More than one column.
    #[error("two columns are named, \"{first}\" and \"{second}\",")]
    TwoColumns {
        /// The first.
        first: String,
        /// The second.
        second: String,
    },
    /// A column times itself, or below a fraction bar.
    #[error("the column multiplies itself or stands below a fraction bar")]
    NotLinear,
    /// Nothing left of the column.
    #[error("the column has no weight")]
    NoWeight,
    /// Numbers too large, or divided by zero.
    #[error("a number is not finite")]
    NotFinite,
    /// Parentheses and the like.
    #[error("'{character}' cannot be used")]
    Unexpected {
        /// The character.
        character: char,
    },
}

/// `gain * column + offset`.
#[derive(Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) column: String,
    pub(crate) gain: f64,
    pub(crate) offset: f64,
}

#[derive(Debug, PartialEq)]
enum Token {
    Number(f64),
    Column(String),
    Operator(char),
}

/// Parses a linear expression. A name that begins with a digit or holds an operator stands in quotes.
pub(crate) fn parse(text: &str) -> Result<Line, ExpressionFault> {
    let tokens = tokenize(text)?;
    let mut rest = tokens.as_slice();
    let mut line = Line { column: String::new(), gain: 0.0, offset: 0.0 };
    let mut seen = false;
    while !rest.is_empty() || !seen {
        let mut sign = 1.0;
        // The first term may go without a sign; a second one (`- -3`) belongs to the number.
        let mut signs = 0;
        while let [Token::Operator(operator @ ('+' | '-')), tail @ ..] = rest {
            if *operator == '-' {
                sign = -sign;
            }
            signs += 1;
            rest = tail;
        }
        if seen && signs == 0 {
            return Err(ExpressionFault::OperatorMissing);
        }
        rest = term(rest, sign, &mut line)?;
        seen = true;
    }
    if line.column.is_empty() {
        return Err(ExpressionFault::NoColumn);
    }
    if !line.gain.is_finite() || !line.offset.is_finite() {
        return Err(ExpressionFault::NotFinite);
    }
    if line.gain == 0.0 {
        return Err(ExpressionFault::NoWeight);
    }
    Ok(line)
}

/// One product or quotient; returns what follows it.
fn term<'a>(mut rest: &'a [Token], sign: f64, line: &mut Line) -> Result<&'a [Token], ExpressionFault> {
    let mut weight = sign;
    let mut has_column = false;
    let mut divide = false;
    loop {
        let mut factor_sign = 1.0;
        while let [Token::Operator(operator @ ('+' | '-')), tail @ ..] = rest {
            if *operator == '-' {
                factor_sign = -factor_sign;
            }
            rest = tail;
        }
        match rest {
            [Token::Number(number), tail @ ..] => {
                let number = factor_sign * number;
                weight = if divide { weight / number } else { weight * number };
                rest = tail;
            }
            [Token::Column(name), tail @ ..] => {
                if has_column || divide {
                    return Err(ExpressionFault::NotLinear);
                }
                if !line.column.is_empty() && line.column != *name {
                    return Err(ExpressionFault::TwoColumns { first: line.column.clone(), second: name.clone() });
                }
                line.column.clone_from(name);
                has_column = true;
                weight *= factor_sign;
                rest = tail;
            }
            _ => return Err(ExpressionFault::Incomplete),
        }
        match rest {
            [Token::Operator(operator @ ('*' | '/')), tail @ ..] => {
                divide = *operator == '/';
                rest = tail;
            }
            _ => break,
        }
    }
    if has_column {
        line.gain += weight;
    } else {
        line.offset += weight;
    }
    Ok(rest)
}

fn tokenize(text: &str) -> Result<Vec<Token>, ExpressionFault> {
    let mut tokens = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '+' | '-' | '*' | '/' => {
                tokens.push(Token::Operator(first));
                first.len_utf8()
            }
            '"' | '`' | '\'' => {
                let inside = &rest[1..];
                let end = inside.find(first).ok_or(ExpressionFault::OpenQuote)?;
                tokens.push(Token::Column(inside[..end].trim().to_owned()));
                end + 2
            }
            '0'..='9' | '.' => {
                let end = number_end(rest);
                let word = &rest[..end];
                let number = word.parse().map_err(|_| ExpressionFault::BadNumber { word: word.to_owned() })?;
                tokens.push(Token::Number(number));
                end
            }
            '(' | ')' | '^' | '=' | ',' | ';' => return Err(ExpressionFault::Unexpected { character: first }),
            _ => {
                let end = rest.find(['+', '-', '*', '/', '=', '(', ')', '^', ',', ';']).unwrap_or(rest.len());
                tokens.push(Token::Column(rest[..end].trim_end().to_owned()));
                end
            }
        };
        rest = rest[length..].trim_start();
    }
    Ok(tokens)
}

/// Where a number ends that begins the text; letters stay in it, so that `3x` is refused as a whole.
fn number_end(text: &str) -> usize {
    let mut previous = ' ';
    for (index, character) in text.char_indices() {
        let exponent_sign = matches!(character, '+' | '-') && matches!(previous, 'e' | 'E');
        if !(character.is_alphanumeric() || matches!(character, '.' | ',' | '_') || exponent_sign) {
            return index;
        }
        previous = character;
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_expressions_are_understood() {
        for (text, column, gain, offset) in [
            ("125 * ai0 - 12.5", "ai0", 125.0, -12.5),
            ("125*ai0", "ai0", 125.0, 0.0),
            ("ai0 * 125 + 3", "ai0", 125.0, 3.0),
            ("ai0 / 4", "ai0", 0.25, 0.0),
            ("ai0", "ai0", 1.0, 0.0),
            ("-ai0", "ai0", -1.0, 0.0),
            ("-2.5e-1*ai0 - -3", "ai0", -0.25, 3.0),
            ("5 - 2 * P [V]", "P [V]", -2.0, 5.0),
            ("2 * \"a-b\" + 1", "a-b", 2.0, 1.0),
            ("`0-10 V` / 2", "0-10 V", 0.5, 0.0),
            ("1e3 * x / 2 + 1 / 4", "x", 500.0, 0.25),
        ] {
            assert_eq!(parse(text), Ok(Line { column: column.to_owned(), gain, offset }), "{text}");
        }
    }
}
