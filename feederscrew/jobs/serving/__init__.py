"""The main job in a browser: uploads, designs, the pages and answers, and the server that bounds them."""
