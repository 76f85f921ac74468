"""What is wrong with a program, known without running it."""
