//! A JSON value that knows its path, so that an error can say where it is.

use serde_json::Value;

/// What is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Wrong {
    pub(crate) at: String,
    pub(crate) problem: String,
}

/// A value and the way to it from the root `$`.
#[derive(Clone, Debug)]
pub(crate) struct Node<'a> {
    value: &'a Value,
    at: String,
}

impl<'a> Node<'a> {
    pub(crate) fn root(value: &'a Value) -> Self {
        Self { value, at: "$".to_owned() }
    }

    pub(crate) fn wrong(&self, problem: impl Into<String>) -> Wrong {
        Wrong { at: self.at.clone(), problem: problem.into() }
    }

    /// A member of an object; `None` where it is absent or null.
    pub(crate) fn get(&self, key: &str) -> Result<Option<Self>, Wrong> {
        let Value::Object(members) = self.value else {
            return Err(self.wrong("must be an object"));
        };
        Ok(members
            .get(key)
            .filter(|value| !value.is_null())
            .map(|value| Self { value, at: format!("{}.{key}", self.at) }))
    }

    /// A member that must be there.
    pub(crate) fn need(&self, key: &str) -> Result<Self, Wrong> {
        self.get(key)?.ok_or_else(|| self.wrong(format!("lacks `{key}`")))
    }

    /// The members of a list.
    pub(crate) fn list(&self) -> Result<Vec<Self>, Wrong> {
        let Value::Array(values) = self.value else {
            return Err(self.wrong("must be a list"));
        };
        let member = |(i, value)| Self { value, at: format!("{}[{i}]", self.at) };
        Ok(values.iter().enumerate().map(member).collect())
    }

    pub(crate) fn text(&self) -> Result<&'a str, Wrong> {
        self.value.as_str().ok_or_else(|| self.wrong("must be a text"))
    }

    pub(crate) fn integer(&self) -> Option<i64> {
        self.value.as_i64()
    }

    /// A number from `least` to `most`.
    pub(crate) fn number(&self, least: f64, most: f64) -> Result<f64, Wrong> {
        let number = self.value.as_f64().ok_or_else(|| self.wrong("must be a number"))?;
        if (least..=most).contains(&number) {
            Ok(number)
        } else {
            Err(self.wrong(format!("= {number} must lie from {least} to {most}")))
        }
    }

    /// A member that is a number from `least` to `most`, where it is there.
    pub(crate) fn number_at(&self, key: &str, least: f64, most: f64) -> Result<Option<f64>, Wrong> {
        self.get(key)?.map(|node| node.number(least, most)).transpose()
    }
}
