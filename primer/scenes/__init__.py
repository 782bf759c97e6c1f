"""What an explorer asks: a few numbers in, one frozen answer with a verdict in words out. Nothing is drawn here."""
