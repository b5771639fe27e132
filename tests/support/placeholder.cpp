namespace adamas {}
