//! stepwave
