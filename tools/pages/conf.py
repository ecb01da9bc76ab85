"""How Sphinx makes the pages: from Markdown (MyST), with nothing from elsewhere in them."""

project = "Tactus"
html_title = "Tactus"
extensions = ["myst_parser"]
myst_heading_anchors = 3
# A reference to a class of ours that is not there is an error, as every warning is (tools/docs.py).
nitpicky = True
highlight_language = "text"
html_theme = "alabaster"
html_show_sourcelink = False
html_copy_source = False
html_show_copyright = False
html_static_path = ["static"]
html_css_files = ["narrow.css"]
html_theme_options = {"page_width": "1100px", "sidebar_width": "250px"}
