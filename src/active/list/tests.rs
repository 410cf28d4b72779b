//! The list beside a model of plain vectors, compared whole after every step.
