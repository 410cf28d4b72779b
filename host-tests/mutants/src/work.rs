//! Work shared among threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Does `one(worker, n)` for all n below `count`, until one of them is an error. What a call gives is
/// collected; after the first `None` no further n is begun.
///
/// # Errors
/// The first error.
pub fn share<T: Send>(
    jobs: usize,
    count: usize,
    one: impl Fn(usize, usize) -> Result<Option<T>, String> + Sync,
) -> Result<Vec<T>, String> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new((Vec::new(), None));
    thread::scope(|scope| {
        for worker in 0..jobs.max(1) {
            let (next, done, one) = (&next, &done, &one);
            scope.spawn(move || {
                loop {
                    let at = next.fetch_add(1, Ordering::Relaxed);
                    if at >= count {
                        return;
                    }
                    let result = one(worker, at);
                    let mut done = done.lock().expect("no thread panics with it");
                    match result {
                        Ok(Some(value)) => done.0.push(value),
                        Ok(None) => next.store(count, Ordering::Relaxed),
                        Err(error) => {
                            done.1.get_or_insert(error);
                            next.store(count, Ordering::Relaxed);
                        }
                    }
                }
            });
        }
    });
    match done.into_inner().expect("no thread panics with it") {
        (_, Some(error)) => Err(error),
        (values, None) => Ok(values),
    }
}
