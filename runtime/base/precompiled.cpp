// Makes the precompiled header that the rooms share where they are built with a sanitizer.
