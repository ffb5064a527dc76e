"""A real camera's GenICam description, evaluated (hilcam-camera-face). Start with binding.py."""
