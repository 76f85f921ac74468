"""What expressions compute with: kinds of values, poses, and the functions of the language."""
