//! A cache of what was used last.

/// A cache of values by key: the value that was not used for the longest time is dropped
/// first.
#[derive(Debug)]
pub struct Recent<K, V> {
    most: usize,
    /// In the order of their last use.
    known: Vec<(K, V)>,
}

impl<K, V: Clone> Recent<K, V> {
    /// A cache of at most `most` values, but at least one.
    #[must_use]
    pub const fn new(most: usize) -> Self {
        Self { most, known: Vec::new() }
    }

    /// The value whose key is `is_it`; `make` makes key and value if the cache has none.
    ///
    /// # Errors
    /// Those of `make`; the cache stays as it is.
    pub fn get<E>(
        &mut self,
        is_it: impl Fn(&K) -> bool,
        make: impl FnOnce() -> Result<(K, V), E>,
    ) -> Result<V, E> {
        let found = match self.known.iter().position(|(key, _)| is_it(key)) {
            Some(at) => self.known.remove(at),
            None => make()?,
        };
        if self.known.len() >= self.most.max(1) {
            self.known.remove(0);
        }
        let value = found.1.clone();
        self.known.push(found);
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_used_stays_and_what_is_not_goes() {
        let mut recent = Recent::new(2);
        let mut made = Vec::new();
        let mut get = |key: u32| {
            let make = || {
                made.push(key);
                Ok::<_, String>((key, key * 10))
            };
            assert_eq!(recent.get(|known| *known == key, make), Ok(key * 10));
        };
        for key in [1, 2, 1, 3, 1, 2] {
            get(key);
        }
        assert_eq!(made, [1, 2, 3, 2], "2 went for 3, and 3 for 2");
        let failed = recent.get(|_| false, || Err("no".to_owned()));
        assert_eq!(failed, Err("no".to_owned()));
        assert_eq!(recent.get(|key| *key == 1, || Err("gone".to_owned())), Ok(10));
    }
}
