//! Tables and figures, to any writer.
